"""The linear light-field estimate  l = Sigma^-1 Phi' i,  Sigma = diag(Phi' Phi)  [Jayasuriya2017, Sec. 3.3.2]."""

import numpy as np

from models.pixel.weights import view_weights

from .demosaic import demosaic


def linear_light_field(pairs, sensor, white, read=None):
    """l[v, u, y, x], (views, views, rows, cols), relative radiance, from raw samples.

    pairs: both diodes of every pixel, (rows, cols, 2), in LSB. white: LSB of one diode under a flat white scene, on
    average over the types. read: bool (rows, cols) or None = all.

    The 24 types are demosaiced first, so that all 48 measurements stand at every pixel. Sigma knows the diagonal
    alone, though the columns of Phi overlap (all are positive); so each view is scaled by what a uniform scene would
    give, which comes back exact.
    """
    weights = view_weights(sensor.tile, sensor.optics)
    measured = np.stack([demosaic(pairs[..., d], sensor.tile, read) for d in (0, 1)], 1)
    seen = np.ones(len(weights), bool)
    if read is not None:
        seen[:] = False
        seen[np.unique(sensor.tile.type_map(*read.shape)[read])] = True
    back = (weights * seen[:, None, None, None]).reshape(-1, *weights.shape[2:])        # Phi of one pixel: (48, v, u)
    uniform = np.tensordot(back, back.sum((1, 2)), (0, 0))
    back = (back / (uniform * white)).astype(pairs.dtype)
    return np.tensordot(back, measured.reshape(-1, *pairs.shape[:2]), (0, 0))
