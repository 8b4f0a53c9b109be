"""A camera as a linear map from a light field to samples: weights over the pupil, which repeat over the pixels."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError

Floats = npt.NDArray[np.floating]
Ints = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Projection:
    """Linear map from l[v, u, y, x] to the samples of every pixel.

    shape: rows and columns of the array.
    weights: (responses, pupil, pupil), responses over a grid of cells of the pupil.
    order: (channels, high, wide), response of every sample of a pixel, in a period of pixels.
    telling: (responses,), responses that tell a disparity, not only the texture.
    side: side, in px, of the squares whose mean every pixel within sees (a lenslet); 1 is the pixel itself. Odd.
    block: rows and columns of pixels that are estimated together, a part of a period; None is a period.

    Raises ParameterError for weights, order or side that do not go together.
    """

    shape: tuple[int, int]
    weights: npt.NDArray[np.float64]
    order: Ints
    telling: npt.NDArray[np.bool_]
    side: int = 1
    block: tuple[int, int] | None = None

    def __post_init__(self) -> None:
        count, high, wide = len(self.weights), *self.order.shape[1:]
        if self.weights.ndim != 3 or self.weights.shape[1] != self.weights.shape[2]:
            raise ParameterError(f"weights = {self.weights.shape}: must be (responses, pupil, pupil)")
        if self.order.min() < 0 or self.order.max() >= count:
            raise ParameterError(f"order = {self.order.min()}..{self.order.max()}: must be in 0..{count - 1}")
        if self.telling.shape != (count,):
            raise ParameterError(f"telling = {self.telling.shape}: must be ({count},)")
        if self.side % 2 == 0 or self.side < 1 or (self.side > 1 and (high % self.side or wide % self.side)):
            raise ParameterError(f"side = {self.side}: must be odd, and divide the period of {high} x {wide} pixels")
        if self.side > 1 and any(length % self.side for length in self.shape):
            raise ParameterError(f"shape = {self.shape}: must be whole squares of {self.side} px")

    @property
    def channels(self) -> int:
        """Samples of a pixel."""
        return len(self.order)

    @property
    def period(self) -> tuple[int, int]:
        """Rows and columns after which the pixels repeat."""
        return self.order.shape[1], self.order.shape[2]

    @property
    def pupil(self) -> int:
        """Cells along the pupil's diameter."""
        return self.weights.shape[1]

    @cached_property
    def responses(self) -> Ints:
        """Response of every sample, (channels, rows, cols)."""
        rows, cols = (np.arange(length) % period for length, period in zip(self.shape, self.period, strict=True))
        return self.order[:, rows[:, None], cols]

    @cached_property
    def white(self) -> npt.NDArray[np.float64]:
        """Samples of a uniform scene of radiance 1, (channels, rows, cols)."""
        return self.weights.sum((1, 2))[self.responses]

    def seen(self, view: Floats) -> Floats:
        """Return what the pixels see of a view: the means of squares.

        view: (..., rows, cols), radiance at the pixels. Returns (..., rows, cols), ``view`` itself where a pixel sees
        no more.
        """
        if self.side == 1:
            return view
        rows, cols = (length // self.side for length in self.shape)
        mean = view.reshape(*view.shape[:-2], rows, self.side, cols, self.side).mean((-3, -1))
        return np.repeat(np.repeat(mean, self.side, -2), self.side, -1)

    def forward(self, light_field: Floats) -> npt.NDArray[np.float64]:
        """Apply the map.

        light_field: (pupil, pupil, rows, cols), l[v, u, y, x]. Returns (channels, rows, cols), samples. Raises
        ParameterError for a wrong shape.
        """
        self._check("light_field", light_field, (self.pupil, self.pupil, *self.shape))
        out = np.zeros(self.responses.shape)
        for v, u in np.ndindex(self.pupil, self.pupil):
            self.add(out, light_field[v, u], v, u)
        return out

    def add(self, samples: npt.NDArray[np.float64], view: Floats, v: int, u: int) -> None:
        """Add one view to all samples, in place.

        samples: (channels, rows, cols), samples. view: (rows, cols), radiance at the pixels. v, u: row and column of
        the view's cell in the pupil.
        """
        samples += self.weights[:, v, u][self.responses] * self.seen(view)

    def transpose(self, samples: Floats) -> npt.NDArray[np.float64]:
        """Apply the transpose of the map.

        samples: (channels, rows, cols), samples. Returns (pupil, pupil, rows, cols), l[v, u, y, x]. Raises
        ParameterError for a wrong shape.
        """
        self._check("samples", samples, self.responses.shape)
        out = np.empty((self.pupil, self.pupil, *self.shape))
        for v, u in np.ndindex(self.pupil, self.pupil):
            out[v, u] = self.seen((self.weights[:, v, u][self.responses] * samples).sum(0))
        return out

    def _check(self, field: str, values: Floats, shape: tuple[int, ...]) -> None:
        if values.shape != shape:
            raise ParameterError(f"{field} shape = {values.shape}: must be {shape}")
