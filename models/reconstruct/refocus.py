"""Refocusing: the views of a light field, each moved by its share of a disparity, and added [Jayasuriya2017, Ch. 3]."""

import numpy as np
import numpy.typing as npt
from scipy.ndimage import shift


def refocus(light_field: npt.NDArray[np.floating], disparity: float) -> npt.NDArray[np.floating]:
    """Picture of a lens that is focused at a disparity.

    Parameters
    ----------
    light_field : array (views, views, rows, cols)
        l[v, u, y, x].
    disparity : float
        Of what is to be sharp, px per view step.

    Returns
    -------
    array (rows, cols)
        Mean of the views; linear between pixels, constant outside.
    """
    views = len(light_field)
    out = np.zeros(light_field.shape[2:], light_field.dtype)
    for v, u in np.ndindex(views, views):
        move = ((v - (views - 1) / 2) * disparity, (u - (views - 1) / 2) * disparity)
        out += shift(light_field[v, u], move, order=1, mode="nearest")
    return out / views**2
