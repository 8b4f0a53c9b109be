"""The ordinary 2-D image: the sum of each pair [Jayasuriya2017, Eq. 3.6]."""

import numpy as np
from scipy.ndimage import distance_transform_edt

from models.parameters import ELEMENTARY_CHARGE, AmpTiming
from models.pixel.weights import view_weights

FULL = 255.0  # LSB: both wells of a pair full


def white_sum(sensor, timing=AmpTiming()):
    """LSB of the sum of a pair under a flat white scene, on average over the types, full wells aside."""
    e = sensor.electrical
    return 2 * e.white_current * timing.t_int / sensor.chip.f_clk / ELEMENTARY_CHARGE / e.lsb_electrons


def sum_image(sums, sensor, read=None, timing=AmpTiming()):
    """Relative radiance (1 = white) of every pixel from the sums of its pair: (rows, cols), 0 at least.

    sums: (rows, cols) in LSB; they are clipped to 0..255. read: bool (rows, cols); pixels that were not read take the
    nearest one that was; None = all were. timing: AmpTiming. Each type's own share of the common mode is divided out.
    """
    share = view_weights(sensor.tile, sensor.optics).sum((1, 2, 3)) / 2
    white = white_sum(sensor, timing) * share[sensor.tile.type_map(*sums.shape)]
    out = np.clip(sums, 0, FULL) / white
    if read is None or read.all():
        return out
    if not read.any():
        return np.zeros_like(out)
    return out[tuple(distance_transform_edt(~read, return_distances=False, return_indices=True))]
