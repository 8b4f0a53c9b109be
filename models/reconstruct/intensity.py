"""The ordinary 2-D image: the sum of each pair [Jayasuriya2017, Eq. 3.6]."""

import numpy as np
from scipy.ndimage import distance_transform_edt

from models.pixel.weights import view_weights


def image_from_sums(sums, sensor, white, read=None, full=255.0):
    """Relative radiance (1 = white) of every pixel from the sums of its pair: (rows, cols), 0 at least.

    sums: (rows, cols) in LSB. white: LSB of a pair under a flat white scene. read: bool (rows, cols); pixels that were
    not read take the nearest one that was. full: LSB at which a pair is saturated; sums are clipped there.
    Each type's own share of the common mode is divided out.
    """
    share = view_weights(sensor.tile, sensor.optics).sum((1, 2, 3)) / 2
    out = np.clip(sums, 0, full) / (white * share[sensor.tile.type_map(*sums.shape)])
    if read is None or read.all():
        return out
    if not read.any():
        return np.zeros_like(out)
    return out[tuple(distance_transform_edt(~read, return_distances=False, return_indices=True))]
