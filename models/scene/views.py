"""The light field l[v, u, y, x] of a picture with disparity, with occlusion."""

from functools import cached_property, lru_cache, partial

import numpy as np
import numpy.typing as npt

from talbot.models.scene import warp
from talbot.models.scene.sampling import Sampling
from talbot.models.scene.scene import RADIANCE_MAX, Bools, View

Floats = npt.NDArray[np.float64]

KEPT = 64 << 20  # bytes of shifted pictures at most


class Second:
    """The other picture of a stereo pair: it shows some of what the outer views show and the first picture hides.

    image: (rows, cols), rectified, taken from the right of the first. disparity: (rows, cols), disparity of the first
    picture, px per view step. scale, offset: a pixel of disparity d is ``scale * d + offset`` px to the left in this
    picture.
    """

    def __init__(self, image: Floats, disparity: Floats, scale: float, offset: float) -> None:
        self.image, self.first, self.scale, self.offset = image, disparity, scale, offset

    @cached_property
    def own(self) -> tuple[Floats, Bools]:
        """Return the disparity in this picture, and where it alone shows the surface, both (rows, cols)."""
        everywhere = np.ones(self.first.shape, bool)
        here = np.full(self.first.shape, warp.NO_SURFACE)
        warp.splat(here, self.first, everywhere, -self.scale, -self.offset, 0.0, 0.0)
        alone = here == warp.NO_SURFACE
        warp.fill_rows(here, alone)
        return here, alone

    def claim(self, surface: Floats, dv: float, du: float) -> Bools:
        """Fill the holes of a view's disparity map in place where this picture shows their contents.

        surface: (rows, cols), disparity map of the view; NO_SURFACE is a hole. dv, du: offset of the view in view
        steps. Returns bool (rows, cols): pixels filled.
        """
        shown = np.full(surface.shape, warp.NO_SURFACE)
        warp.splat(shown, *self.own, self.scale, self.offset, dv, du)
        return warp.claim(surface, shown, self.image.shape[1] - 1, du - self.scale, -self.offset)


def view(
    image: Floats,
    disparity: Floats,
    dv: float,
    du: float,
    second: Second | None = None,
    use: Bools | None = None,
    mask: Bools | None = None,
) -> tuple[Floats, Floats]:
    """Compute one view from the centre picture.

    image: (rows, cols), the centre picture. disparity: (rows, cols), its disparity, px per view step. dv, du: offset of
    the view in view steps. second: the other picture of a pair. use: bool (rows, cols), pixels of the picture that show
    one surface alone; None is all. mask: bool (rows, cols), pixels of the view to compute; None is all. Returns image
    (rows, cols): the view; disparity (rows, cols): its disparity map.
    """
    if dv == 0 and du == 0:
        return image.copy(), disparity.copy()
    use = np.ones(disparity.shape, bool) if use is None else use
    mask = np.ones(disparity.shape, bool) if mask is None else mask
    if np.ptp(disparity):
        surface = np.full(disparity.shape, warp.NO_SURFACE)
        warp.splat(surface, disparity, use, 0.0, 0.0, dv, du)
    else:
        surface = disparity.copy()  # a plane hides nothing; its border goes on outside
    other = np.zeros_like(mask) if second is None else second.claim(surface, dv, du)
    y, x, behind_y, behind_x = warp.background(surface, mask, dv, du).T
    if y.size:
        mask = mask.copy()
        mask[behind_y, behind_x] = True
    out = np.zeros(image.shape)
    warp.fetch(out, image, surface, mask, dv, du, 0.0, RADIANCE_MAX)
    if second is not None:
        warp.fetch(out, second.image, surface, mask & other, dv, du - second.scale, -second.offset, RADIANCE_MAX)
    out[y, x], surface[y, x] = out[behind_y, behind_x], surface[behind_y, behind_x]
    return out, surface


class Pictured:
    """All views of a picture with disparity, computed where they are wanted.

    image, disparity: (rows + 2 margin, cols + 2 margin), the centre picture and its disparity, px per view step.
    sampling: array and views. second: the other picture of a pair. margin: px around the array that only the outer
    views need.
    """

    def __init__(
        self, image: Floats, disparity: Floats, sampling: Sampling, second: Second | None = None, margin: int = 0
    ) -> None:
        self.image, self.disparity, self.sampling, self.second, self.margin = image, disparity, sampling, second, margin
        self.reach = int(np.ceil(np.abs(disparity).max() * sampling.views / 2)) + 2  # px: of the pupil's rim
        self.inner = (slice(margin, margin + sampling.rows), slice(margin, margin + sampling.cols))

    @cached_property
    def use(self) -> Bools:
        """Pixels whose disparity is of one surface, bool (rows + 2 margin, cols + 2 margin)."""
        return warp.unmixed(self.disparity)

    def __call__(self, mask: Bools) -> View:
        """Views at some pixels.

        mask: bool (rows, cols), pixels to compute; the others are undefined. Returns View: of an offset of at most
        views / 2 steps.
        """
        whole = np.zeros(self.image.shape, bool)
        whole[self.inner] = mask
        if mask.all():
            return lambda dv, du: self._view(dv, du, np.ones_like(whole), self.use)
        # A hole is filled from at most the reach away, and a pixel is warped from as far.
        from scipy.ndimage import maximum_filter  # it imports for long

        use = self.use & np.asarray(maximum_filter(whole, 4 * self.reach + 1), bool)
        return lambda dv, du: self._view(dv, du, whole, use)

    def _view(self, dv: float, du: float, mask: Bools, use: Bools) -> tuple[Floats, Floats]:
        image, surface = view(self.image, self.disparity, dv, du, self.second, use, mask)
        return image[self.inner], surface[self.inner]


class Shifted:
    """All views of a picture on a plane parallel to the sensor: the picture, shifted.

    The same values as of `Pictured`, in a fraction of its time: what views of one row or column of the pupil have in
    common is kept.

    image: (rows, cols), the centre picture. disparity: of the plane, px per view step.
    """

    def __init__(self, image: Floats, disparity: float) -> None:
        self.image, self.disparity = image, disparity
        self.surface = np.broadcast_to(disparity, image.shape)
        self._across = lru_cache(max(1, KEPT // image.nbytes))(partial(_across, image, disparity))

    def __call__(self, mask: Bools) -> View:
        """Views at some pixels.

        mask: bool (rows, cols), pixels to compute; the others are undefined. Returns View: of any offset.
        """
        rows = np.flatnonzero(mask.any(1))
        return lambda dv, du: (self._view(dv, du, rows), self.surface)

    def _view(self, dv: float, du: float, rows: npt.NDArray[np.int64]) -> Floats:
        if dv == 0 and du == 0:
            return self.image.copy()
        out = np.zeros(self.image.shape)
        places = np.arange(len(out), dtype=np.float64) + dv * self.disparity
        warp.shift_rows(out, self._across(du), places, rows, RADIANCE_MAX)
        return out


def _across(image: Floats, disparity: float, du: float) -> Floats:
    """Return a picture shifted along its rows."""
    out = np.empty_like(image)
    warp.shift_columns(out, image, np.arange(len(image[0]), dtype=np.float64) + du * disparity)
    return out
