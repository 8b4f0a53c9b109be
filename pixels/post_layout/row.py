"""A line of the drawn circuits' datasheet."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Row:
    """A characteristic at a corner, of the schematic and of the layout. most, least: its limits, or None."""

    name: str
    unit: str
    schematic: float
    layout: float
    corner: str
    most: float | None = None
    least: float | None = None

    @property
    def passes(self) -> bool:
        """True if the layout is inside the limit."""
        below = self.most is None or abs(self.layout) <= self.most
        return below and (self.least is None or self.layout >= self.least)
