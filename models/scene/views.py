"""From a picture with disparity to the whole light field l[v, u, y, x], with occlusion."""

import numpy as np
import numpy.typing as npt

from . import warp
from .sampling import Sampling
from .scene import RADIANCE_MAX

Floats = npt.NDArray[np.float64]


class Second:
    """The other picture of a stereo pair: it shows some of what the outer views show and the first picture hides.

    Parameters
    ----------
    image : float64 (rows, cols)
        Rectified, taken from the right of the first.
    disparity : float64 (rows, cols)
        Disparity of the first picture, px per view step.
    scale, offset : float
        A pixel of disparity d is ``scale * d + offset`` px to the left in this picture.
    """

    def __init__(self, image: Floats, disparity: Floats, scale: float, offset: float) -> None:
        self.image, self.scale, self.offset = image, scale, offset
        everywhere = np.ones(disparity.shape, bool)
        here = np.full(disparity.shape, warp.NO_SURFACE)
        warp.splat(here, disparity, everywhere, -(scale * disparity + offset), 0.0, 0.0)
        self.alone = here == warp.NO_SURFACE  # shown by this picture alone
        warp.fill_rows(here, self.alone)
        self.disparity = here

    def fill(self, out: Floats, surface: Floats, dv: float, du: float) -> None:
        """Fill the holes of a view (surface == NO_SURFACE) in place where this picture shows their contents.

        Parameters
        ----------
        out : float64 (rows, cols)
            Radiance of the view.
        surface : float64 (rows, cols)
            Disparity map of the view.
        dv, du : float
            Offset of the view in view steps.
        """
        own = np.full(surface.shape, warp.NO_SURFACE)
        warp.splat(own, self.disparity, self.alone, self.scale * self.disparity + self.offset, dv, du)
        warp.fetch_second(out, surface, own, self.image, self.scale, self.offset, dv, du, RADIANCE_MAX)


def view(
    image: Floats,
    disparity: Floats,
    dv: float,
    du: float,
    second: Second | None = None,
    use: npt.NDArray[np.bool_] | None = None,
) -> tuple[Floats, Floats]:
    """Compute one view from the centre picture.

    Parameters
    ----------
    image : float64 (rows, cols)
        The centre picture.
    disparity : float64 (rows, cols)
        Its disparity, px per view step.
    dv, du : float
        Offset of the view in view steps.
    second : Second, optional
        The other picture of a pair.
    use : bool (rows, cols), optional
        Pixels of the picture that show one surface alone; None is all.

    Returns
    -------
    image : float64 (rows, cols)
        The view.
    disparity : float64 (rows, cols)
        Its disparity map.
    """
    if dv == 0 and du == 0:
        return image.copy(), disparity.copy()
    use = np.ones(disparity.shape, bool) if use is None else use
    surface = np.full(disparity.shape, warp.NO_SURFACE)
    warp.splat(surface, disparity, use, np.zeros(disparity.shape), dv, du)
    out = np.zeros(image.shape)
    warp.fetch(out, image, surface, dv, du, RADIANCE_MAX)
    if second is not None:
        second.fill(out, surface, dv, du)
    warp.fill_from_background(out, surface, dv, du)
    return out, surface


def light_field(
    image: Floats, disparity: Floats, sampling: Sampling, second: Second | None = None, margin: int = 0
) -> npt.NDArray[np.floating]:
    """Compute all views of a centre picture.

    Parameters
    ----------
    image, disparity : float64 (rows + 2 margin, cols + 2 margin)
        The centre picture and its disparity, px per view step.
    sampling : Sampling
        Array and views.
    second : Second, optional
        The other picture of a pair.
    margin : int
        Px around the array that only the outer views need.

    Returns
    -------
    array (views, views, rows, cols)
        l[v, u, y, x] of the sampling's type.
    """
    size = sampling.views, sampling.views, *sampling.shape
    out = np.empty(size, sampling.dtype)
    inner = (slice(margin, margin + sampling.rows), slice(margin, margin + sampling.cols))
    use = warp.unmixed(disparity)
    for i, dv in enumerate(sampling.steps):
        for j, du in enumerate(sampling.steps):
            out[i, j] = view(image, disparity, dv, du, second, use)[0][inner]
    return out
