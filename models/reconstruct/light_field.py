"""The linear light-field estimate  l = Sigma^-1 Phi' i,  Sigma = diag(Phi' Phi)  [Jayasuriya2017, Sec. 3.3.2]."""

import numpy as np
import numpy.typing as npt

from talbot.models.capture import CaptureOperator
from talbot.models.parameters import ParameterError
from talbot.models.reconstruct.demosaic import demosaic


def light_field_estimate(operator: CaptureOperator, pair: npt.NDArray[np.floating]) -> npt.NDArray[np.floating]:
    """Linear estimate of the light field.

    The 24 types are demosaiced first, so that every pixel has all 48 measurements. Sigma contains the diagonal alone,
    though the columns of Phi overlap (all are positive); each view is therefore scaled such that the estimate of a
    uniform scene is exact.

    operator: operator of all views; pixels that it does not read do not count. pair: (2, rows, cols), both diodes of
    every pixel. Returns (views, views, rows, cols), l[v, u, y, x] in the unit and type of ``pair`` (a white diode's
    photocurrent = white); 0 in the corners that the round pupil does not reach (`models.capture.cells`). Raises
    ParameterError for an operator of one view or a wrong shape. Source: [Jayasuriya2017], Sec. 3.3.2.
    """
    shape = operator.rows, operator.cols
    if not operator.angular:
        raise ParameterError("angular = False: the estimate needs the operator of all views")
    if pair.shape != (2, *shape):
        raise ParameterError(f"pair shape = {pair.shape}: must be {(2, *shape)}")
    tile, read = operator.sensor.tile, operator.read
    measured = np.stack([demosaic(diode, tile, read) for diode in pair], 1)
    kinds = tile.type_map(*shape)
    seen = np.isin(np.arange(tile.n_types), kinds if read is None else kinds[read])
    if not seen.any():
        return np.zeros(operator.shape, pair.dtype)
    # Phi of one pixel, all types demosaiced to it: (48, v, u).
    back = (operator.weights.astype(float) * seen[:, None, None, None]).reshape(-1, *operator.shape[:2])
    scale = np.tensordot(back, back.sum((1, 2)), (0, 0))
    back /= np.where(scale > 0, scale, 1)
    return np.tensordot(back.astype(pair.dtype), measured.reshape(-1, *shape), (0, 0))
