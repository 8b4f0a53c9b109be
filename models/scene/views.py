"""A picture with disparity -> the whole light field l[v, u, y, x], occlusion handled."""

import numpy as np

from . import warp
from .scene import RADIANCE_MAX


class Second:
    """The other picture of a stereo pair: it sees some of what the outer views see and the first does not.

    image: (rows, cols), rectified, taken from the right of the first.
    disparity: of the first picture, px a view step, (rows, cols).
    offset, scale: a pixel of disparity d lies ``scale * d + offset`` px to the left here.
    """

    def __init__(self, image, disparity, scale, offset):
        self.image, self.scale, self.offset = image, scale, offset
        everywhere = np.ones(disparity.shape, bool)
        here = np.full(disparity.shape, warp.BEHIND)
        warp.splat(here, disparity, everywhere, -(scale * disparity + offset), 0.0, 0.0)
        self.alone = here == warp.BEHIND  # what only this picture sees
        warp.fill_rows(here, self.alone)
        self.disparity = here

    def fill(self, out, surface, dv, du):
        """Fill the holes of a view (surface == BEHIND) in place where this picture sees what is behind them."""
        own = np.full(surface.shape, warp.BEHIND)
        warp.splat(own, self.disparity, self.alone, self.scale * self.disparity + self.offset, dv, du)
        warp.fetch_second(out, surface, own, self.image, self.scale, self.offset, dv, du, RADIANCE_MAX)


def view(image, disparity, dv, du, second=None, use=None):
    """One view (rows, cols) and its disparity map, from the centre picture and its disparity (px a view step).

    use: bool (rows, cols), pixels of the picture that show one surface alone; None = all.
    """
    if dv == 0 and du == 0:
        return image.copy(), disparity.copy()
    use = np.ones(disparity.shape, bool) if use is None else use
    surface = np.full(disparity.shape, warp.BEHIND)
    warp.splat(surface, disparity, use, np.zeros(disparity.shape), dv, du)
    out = np.zeros(image.shape)
    warp.fetch(out, image, surface, dv, du, RADIANCE_MAX)
    if second is not None:
        second.fill(out, surface, dv, du)
    warp.fill_from_background(out, surface, dv, du)
    return out, surface


def light_field(image, disparity, sampling, second=None, margin=0):
    """All views of a centre picture: (views, views, rows, cols) of the sampling's type.

    image, disparity: (rows + 2 margin, cols + 2 margin) float64; the margin feeds the outer views and is cut off.
    """
    size = sampling.views, sampling.views, *sampling.shape
    out = np.empty(size, sampling.dtype)
    inner = (slice(margin, margin + sampling.rows), slice(margin, margin + sampling.cols))
    use = warp.unmixed(disparity)
    for i, dv in enumerate(sampling.steps):
        for j, du in enumerate(sampling.steps):
            out[i, j] = view(image, disparity, dv, du, second, use)[0][inner]
    return out
