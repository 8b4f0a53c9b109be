"""Surfaces one before the other as views see them, and the transposes: masks and textures to a light field and back."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from talbot.models.reconstruct.warps import gather, gather_linear, scatter, scatter_linear

Floats = npt.NDArray[np.floating]


class Stack:
    """Surfaces as views see them.

    disparity: (rows + 2 margin, cols + 2 margin), of the surfaces, the nearest first, px per view step.
    steps: (views,), places of the views down and across, in view steps.
    margin: px around the array.
    """

    def __init__(self, disparity: Sequence[Floats], steps: npt.NDArray[np.float64], margin: int) -> None:
        self.count, self.whole = len(disparity), disparity[0].shape
        self.shape = (len(steps), len(steps), *(size - 2 * margin for size in self.whole))
        y, x = (place.astype(np.float32) + margin for place in np.indices(self.shape[2:]))
        self.places = np.empty((self.count, 2, *self.shape), np.float32)
        for k, surface in enumerate(disparity):
            for v, u in np.ndindex(self.shape[:2]):
                down, across, seen = y, x, np.empty_like(y)
                for _ in range(4):  # of what a view shows at a pixel
                    gather_linear(surface, down, across, seen)
                    down = y + np.float32(steps[v]) * seen
                    across = x + np.float32(steps[u]) * seen
                self.places[k, :, v, u] = down, across

    def warped(self, k: int, picture: Floats, linear: bool = False) -> Floats:
        """Show a picture of a surface in every view.

        k: number of the surface. picture: (rows + 2 margin, cols + 2 margin), as the middle view shows it. linear:
        interpolate linearly, not by cubic convolution. Returns (views, views, rows, cols), l[v, u, y, x].
        """
        out = np.empty(self.shape, np.float32)
        for v, u in np.ndindex(self.shape[:2]):
            (gather_linear if linear else gather)(picture, *self.places[k, :, v, u], out[v, u])
        return out

    def back(self, k: int, field: Floats, linear: bool = False) -> Floats:
        """Apply the transpose of `warped`.

        k: number of the surface. field: (views, views, rows, cols), a light field. linear: as of `warped`. Returns
        (rows + 2 margin, cols + 2 margin), a picture of the surface.
        """
        out = np.zeros(self.whole, np.float32)
        for v, u in np.ndindex(self.shape[:2]):
            (scatter_linear if linear else scatter)(out, *self.places[k, :, v, u], field[v, u])
        return out

    def seen(self, masks: Sequence[Floats]) -> list[Floats]:
        """Tell how much of every surface each view shows.

        masks: (rows + 2 margin, cols + 2 margin), of all surfaces but the farthest, 0..1. Returns (views, views, rows,
        cols), of every surface; their sum is 1.
        """
        left, out = np.ones(self.shape, np.float32), []
        for k, mask in enumerate(masks):
            shown = self.warped(k, mask, linear=True)
            out.append(left * shown)
            left = left * (1 - shown)
        return [*out, left]

    def field(self, textures: Floats, seen: Sequence[Floats]) -> Floats:
        """Compose the light field.

        textures: (surfaces, rows + 2 margin, cols + 2 margin), of every surface. seen: (views, views, rows, cols), as
        of `seen`. Returns (views, views, rows, cols), l[v, u, y, x].
        """
        return np.asarray(sum(part * self.warped(k, textures[k]) for k, part in enumerate(seen)), np.float32)

    def textures(self, field: Floats, seen: Sequence[Floats]) -> Floats:
        """Apply the transpose of `field`.

        field: (views, views, rows, cols), a light field. seen: (views, views, rows, cols), as of `seen`. Returns
        (surfaces, rows + 2 margin, cols + 2 margin), pictures of the surfaces.
        """
        return np.stack([self.back(k, part * field) for k, part in enumerate(seen)])
