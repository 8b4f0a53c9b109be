"""Surfaces one before the other as views see them, and the transposes: masks and textures to a light field and back."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from talbot.models.reconstruct.warps import gather, gather_linear, scatter, scatter_linear

Floats = npt.NDArray[np.floating]


class Stack:
    """Surfaces as views see them.

    Parameters
    ----------
    disparity : sequence of float32 (rows + 2 margin, cols + 2 margin)
        Of the surfaces, the nearest first, px per view step.
    steps : float64 (views,)
        Places of the views down and across, in view steps.
    margin : int
        Px around the array.
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

        Parameters
        ----------
        k : int
            Number of the surface.
        picture : float32 (rows + 2 margin, cols + 2 margin)
            As the middle view shows it.
        linear : bool
            Interpolate linearly, not by cubic convolution.

        Returns
        -------
        float32 (views, views, rows, cols)
            l[v, u, y, x].
        """
        out = np.empty(self.shape, np.float32)
        for v, u in np.ndindex(self.shape[:2]):
            (gather_linear if linear else gather)(picture, *self.places[k, :, v, u], out[v, u])
        return out

    def back(self, k: int, field: Floats, linear: bool = False) -> Floats:
        """Apply the transpose of `warped`.

        Parameters
        ----------
        k : int
            Number of the surface.
        field : float32 (views, views, rows, cols)
            A light field.
        linear : bool
            As of `warped`.

        Returns
        -------
        float32 (rows + 2 margin, cols + 2 margin)
            A picture of the surface.
        """
        out = np.zeros(self.whole, np.float32)
        for v, u in np.ndindex(self.shape[:2]):
            (scatter_linear if linear else scatter)(out, *self.places[k, :, v, u], field[v, u])
        return out

    def seen(self, masks: Sequence[Floats]) -> list[Floats]:
        """Tell how much of every surface each view shows.

        Parameters
        ----------
        masks : sequence of float32 (rows + 2 margin, cols + 2 margin)
            Of all surfaces but the farthest, 0..1.

        Returns
        -------
        list of float32 (views, views, rows, cols)
            Of every surface; their sum is 1.
        """
        left, out = np.ones(self.shape, np.float32), []
        for k, mask in enumerate(masks):
            shown = self.warped(k, mask, linear=True)
            out.append(left * shown)
            left = left * (1 - shown)
        return [*out, left]

    def field(self, textures: Floats, seen: Sequence[Floats]) -> Floats:
        """Compose the light field.

        Parameters
        ----------
        textures : float32 (surfaces, rows + 2 margin, cols + 2 margin)
            Of every surface.
        seen : sequence of float32 (views, views, rows, cols)
            As of `seen`.

        Returns
        -------
        float32 (views, views, rows, cols)
            l[v, u, y, x].
        """
        return np.asarray(sum(part * self.warped(k, textures[k]) for k, part in enumerate(seen)), np.float32)

    def textures(self, field: Floats, seen: Sequence[Floats]) -> Floats:
        """Apply the transpose of `field`.

        Parameters
        ----------
        field : float32 (views, views, rows, cols)
            A light field.
        seen : sequence of float32 (views, views, rows, cols)
            As of `seen`.

        Returns
        -------
        float32 (surfaces, rows + 2 margin, cols + 2 margin)
            Pictures of the surfaces.
        """
        return np.stack([self.back(k, part * field) for k, part in enumerate(seen)])
