"""The 24 pixel types and the order in which they lie in a tile [Jayasuriya2017, Sec. 3.5.1, Fig. 6.3]."""

from dataclasses import dataclass, field

import numpy as np

from .checks import ParameterError, check_int, check_real


@dataclass(frozen=True)
class PixelType:
    """One grating stack.

    beta: angular frequency, 0..50 (rad of response per rad of angle).
    gamma_deg: grating orientation, -180..180 degrees.
    alpha: phase of the analyzer grating, -2 pi..2 pi rad.
    """

    beta: float
    gamma_deg: float
    alpha: float

    def __post_init__(self):
        check_real("beta", self.beta, 0, 50)
        check_real("gamma_deg", self.gamma_deg, -180, 180)
        check_real("alpha", self.alpha, -2 * np.pi, 2 * np.pi)

    @property
    def gamma(self):
        """Grating orientation in rad."""
        return np.deg2rad(self.gamma_deg)


def _thesis_types():
    groups = ((12.0, (0.0, 90.0, 45.0, -45.0)), (18.0, (22.5, -22.5, 67.5, -67.5)), (24.0, (0.0, 90.0, 45.0, -45.0)))
    return tuple(
        PixelType(beta, gamma, alpha) for beta, gammas in groups for gamma in gammas for alpha in (0.0, np.pi / 2)
    )


# Position (row by row) -> pixel type. Each row holds two types of every beta and each column
# at least one, so that any patch has an even mix. Models, RTL, layout and documents read it here.
_THESIS_ORDER = (0, 9, 20, 14, 3, 17, 12, 22, 5, 11, 18, 6, 2, 15, 16, 1, 8, 21, 19, 4, 10, 23, 7, 13)


@dataclass(frozen=True)
class TileParameters:
    """A tile of ``rows`` x ``cols`` pixels, one of each type.

    rows, cols: 1..4 and 1..6 pixels.
    types: the pixel types, ``rows * cols`` of them, in the order of the register map.
    order: for each position, row by row, the index of its pixel type: a permutation.
    """

    rows: int = 4
    cols: int = 6
    types: tuple = field(default_factory=_thesis_types)
    order: tuple = _THESIS_ORDER

    def __post_init__(self):
        check_int("tile rows", self.rows, 1, 4)
        check_int("tile cols", self.cols, 1, 6)
        if len(self.types) != self.rows * self.cols:
            raise ParameterError(f"types = {len(self.types)} entries: must be rows * cols = {self.rows * self.cols}")
        if sorted(self.order) != list(range(len(self.types))):
            raise ParameterError(f"order = {self.order!r}: must be a permutation of 0..{len(self.types) - 1}")

    @property
    def n_types(self):
        return len(self.types)

    def type_map(self, rows, cols):
        """Pixel type index of every pixel: int array (rows, cols)."""
        tile = np.reshape(self.order, (self.rows, self.cols))
        return tile[np.arange(rows)[:, None] % self.rows, np.arange(cols)[None, :] % self.cols]
