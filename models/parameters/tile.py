"""The 24 pixel types and their order in a tile [Jayasuriya2017, Sec. 3.5.1, Fig. 6.3]."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Self

import numpy as np
import numpy.typing as npt

from talbot.models.parameters.checks import ParameterError, check_int, check_real

# From incidence angles theta_x and theta_y, arrays (n,) in rad, |theta| <= pi/2, to the response of both diodes,
# (2, n), finite, 0 or more, the aperture A(theta) included: 1 is as sensitive as a plain diode on the axis.
Response = Callable[[npt.NDArray[np.floating], npt.NDArray[np.floating]], npt.ArrayLike]


@dataclass(frozen=True)
class PixelType:
    """One grating stack.

    Attributes
    ----------
    beta : float
        Angular frequency, 0..50 rad of response per rad of angle.
    gamma_deg : float
        Grating orientation, -180..180 degrees.
    alpha : float
        Phase of the analyzer grating, -2 pi..2 pi rad.
    m : float or None
        Modulation depth, 0..1; None is the sensor's own (OpticsParameters.m).
    response : callable or None
        A response instead of Eq. 3.1: see `Response`. ``beta`` then is the fastest angular frequency in
        it, alpha, gamma_deg and m are labels.
    """

    beta: float
    gamma_deg: float
    alpha: float
    m: float | None = None
    response: Response | None = None

    def __post_init__(self) -> None:
        check_real("beta", self.beta, 0, 50, "rad per rad")
        check_real("gamma_deg", self.gamma_deg, -180, 180, "degrees")
        check_real("alpha", self.alpha, -6.2832, 6.2832, "rad")
        if self.m is not None:
            check_real("m", self.m, 0, 1)
        if self.response is not None and not callable(self.response):
            raise ParameterError(f"response = {self.response!r}: must be a function of theta_x and theta_y")

    @property
    def gamma(self) -> float:
        """Grating orientation in rad."""
        return float(np.deg2rad(self.gamma_deg))


def _thesis_types() -> tuple[PixelType, ...]:
    groups = ((12.0, (0.0, 90.0, 45.0, -45.0)), (18.0, (22.5, -22.5, 67.5, -67.5)), (24.0, (0.0, 90.0, 45.0, -45.0)))
    return tuple(
        PixelType(beta, gamma, alpha) for beta, gammas in groups for gamma in gammas for alpha in (0.0, np.pi / 2)
    )


# Position (row by row) -> pixel type. Each row holds two types of every beta and each column
# at least one, so that any patch has an even mix. This is the only copy: models, RTL, layout and documents read it.
_THESIS_ORDER = (0, 9, 20, 14, 3, 17, 12, 22, 5, 11, 18, 6, 2, 15, 16, 1, 8, 21, 19, 4, 10, 23, 7, 13)


@dataclass(frozen=True)
class TileParameters:
    """A tile of pixels, one of each type.

    Attributes
    ----------
    rows, cols : int
        Pixels, 1..4 and 1..6.
    types : tuple of PixelType
        The rows * cols pixel types, in the order of the register map.
    order : tuple of int
        Index of the pixel type at each position, row by row: a permutation.

    References
    ----------
    [Jayasuriya2017], Sec. 3.5.1 and Fig. 6.3.
    """

    rows: int = 4
    cols: int = 6
    types: tuple[PixelType, ...] = field(default_factory=_thesis_types)
    order: tuple[int, ...] = _THESIS_ORDER

    def __post_init__(self) -> None:
        check_int("tile rows", self.rows, 1, 4)
        check_int("tile cols", self.cols, 1, 6)
        for name in ("types", "order"):  # a list is as good; a tuple has a hash
            if isinstance(getattr(self, name), str | bytes) or not isinstance(getattr(self, name), Iterable):
                raise ParameterError(f"{name} = {getattr(self, name)!r}: must be a list")
            object.__setattr__(self, name, tuple(getattr(self, name)))
        for index in self.order:
            check_int("order", index, 0, len(self.types) - 1)
        if len(self.types) != self.rows * self.cols:
            raise ParameterError(f"types = {len(self.types)} entries: must be rows * cols = {self.rows * self.cols}")
        if sorted(self.order) != list(range(len(self.types))):
            raise ParameterError(f"order = {self.order!r}: must be a permutation of 0..{len(self.types) - 1}")

    @classmethod
    def small(cls, rows: int, cols: int) -> Self:
        """Tile of the first pixel types, in the order that they have in the thesis's tile.

        rows, cols: pixels, 1..4 and 1..6. Returns TileParameters: with rows * cols pixel types.
        """
        check_int("tile rows", rows, 1, 4)
        check_int("tile cols", cols, 1, 6)
        count = rows * cols
        return cls(rows, cols, _thesis_types()[:count], tuple(kind for kind in _THESIS_ORDER if kind < count))

    @classmethod
    def of_rows(cls, rows: Iterable[Iterable[PixelType]]) -> Self:
        """Tile of these pixel types, as they stand.

        rows: 1..4 rows of 1..6 types each; a type may stand in several places. Returns TileParameters: its types in
        this order, row by row. Raises ParameterError for rows of different lengths, or too many.
        """
        table = [tuple(row) for row in rows]
        widths = {len(row) for row in table}
        if len(widths) != 1:
            raise ParameterError(f"tile rows = {[len(row) for row in table]} types: must be 1..4 rows of one length")
        return cls(len(table), max(widths), sum(table, ()), tuple(range(len(table) * max(widths))))

    @property
    def n_types(self) -> int:
        """Number of pixel types."""
        return len(self.types)

    def type_map(self, rows: int, cols: int) -> npt.NDArray[np.int64]:
        """Pixel type of every pixel.

        rows, cols: size of the array in pixels. Returns (rows, cols), index into `types`; it cannot be written.
        """
        return _type_map(self.order, self.cols, rows, cols)


@lru_cache(maxsize=16)
def _type_map(order: tuple[int, ...], width: int, rows: int, cols: int) -> npt.NDArray[np.int64]:
    """``order`` over all of an array, from a tile of this width."""
    tile = np.reshape(order, (-1, width))
    out = tile[np.arange(rows)[:, None] % len(tile), np.arange(cols)[None, :] % width]
    out.setflags(write=False)
    return out
