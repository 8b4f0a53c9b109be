"""From a picture with disparity to the whole light field l[v, u, y, x], with occlusion."""

import numpy as np
import numpy.typing as npt
from scipy.ndimage import maximum_filter

from . import warp
from .sampling import Sampling
from .scene import RADIANCE_MAX, Bools, View

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

    def fill(self, out: Floats, surface: Floats, wanted: Bools, dv: float, du: float) -> None:
        """Fill the holes of a view (surface == NO_SURFACE) in place where this picture shows their contents.

        Parameters
        ----------
        out : float64 (rows, cols)
            Radiance of the view.
        surface : float64 (rows, cols)
            Disparity map of the view.
        wanted : bool (rows, cols)
            Pixels to fill.
        dv, du : float
            Offset of the view in view steps.
        """
        own = np.full(surface.shape, warp.NO_SURFACE)
        warp.splat(own, self.disparity, self.alone, self.scale * self.disparity + self.offset, dv, du)
        warp.fetch_second(out, surface, own, self.image, wanted, self.scale, self.offset, dv, du, RADIANCE_MAX)


def view(
    image: Floats,
    disparity: Floats,
    dv: float,
    du: float,
    second: Second | None = None,
    use: Bools | None = None,
    wanted: Bools | None = None,
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
    wanted : bool (rows, cols), optional
        Pixels of the view to compute; None is all.

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
    wanted = np.ones(disparity.shape, bool) if wanted is None else wanted
    if np.ptp(disparity):
        surface = np.full(disparity.shape, warp.NO_SURFACE)
        warp.splat(surface, disparity, use, np.zeros(disparity.shape), dv, du)
    else:
        surface = disparity.copy()  # a plane hides nothing; its border goes on outside
    out = np.zeros(image.shape)
    warp.fetch(out, image, surface, wanted, dv, du, RADIANCE_MAX)
    if second is not None:
        second.fill(out, surface, wanted, dv, du)
    warp.fill_from_background(out, surface, wanted, dv, du)
    return out, surface


class Pictured:
    """All views of a picture with disparity, computed where they are wanted.

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
    """

    def __init__(
        self, image: Floats, disparity: Floats, sampling: Sampling, second: Second | None = None, margin: int = 0
    ) -> None:
        self.image, self.disparity, self.sampling, self.second, self.margin = image, disparity, sampling, second, margin
        self.use = warp.unmixed(disparity)
        self.reach = int(np.ceil(np.abs(disparity).max() * sampling.views / 2)) + 2  # px: of the pupil's rim
        self.inner = (slice(margin, margin + sampling.rows), slice(margin, margin + sampling.cols))

    def __call__(self, wanted: Bools) -> View:
        """Views at some pixels.

        Parameters
        ----------
        wanted : bool (rows, cols)
            Pixels to compute; the others are undefined.

        Returns
        -------
        View
            Of an offset of at most views / 2 steps.
        """
        whole = np.zeros(self.image.shape, bool)
        whole[self.inner] = wanted
        if wanted.all():
            return lambda dv, du: self._view(dv, du, np.ones_like(whole), self.use)
        # A hole is filled from beside it, and a pixel is warped from at most the reach away.
        near = np.asarray(maximum_filter(whole, 2 * self.reach + 1), bool)
        use = self.use & np.asarray(maximum_filter(near, 2 * self.reach + 1), bool)
        return lambda dv, du: self._view(dv, du, near, use)

    def _view(self, dv: float, du: float, wanted: Bools, use: Bools) -> tuple[Floats, Floats]:
        image, surface = view(self.image, self.disparity, dv, du, self.second, use, wanted)
        return image[self.inner], surface[self.inner]

    def light_field(self) -> npt.NDArray[np.floating]:
        """All views of the sampling.

        Returns
        -------
        array (views, views, rows, cols)
            l[v, u, y, x] of the sampling's type.
        """
        steps = self.sampling.steps
        seen = self(np.ones(self.sampling.shape, bool))
        return np.stack([np.stack([seen(dv, du)[0].astype(self.sampling.dtype) for du in steps]) for dv in steps])
