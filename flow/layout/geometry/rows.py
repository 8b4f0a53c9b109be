"""The empty places of a placement's rows: where its fill cells are."""

from bisect import bisect
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from talbot.base.steps import StepError

from ..netlist.placed import MIRRORED

Place = tuple[float, float, str]  # x, y in um and orientation of a cell's origin, as in `netlist.placed.placement`


@dataclass
class Rows:
    """Spans free of cells that do something.

    site: um. height: of a row, um. rows: by (y, orientation), [first site, end] in order.
    """

    site: float
    height: float
    rows: dict[tuple[float, str], list[list[int]]] = field(default_factory=dict)

    def give(self, width: float, place: Place) -> None:
        """Let what a cell ``width`` (um) wide took be free."""
        x, y, orientation = place
        begin, end = round(x / self.site), round((x + width) / self.site)
        spans = self.rows.setdefault((y, orientation), [])
        k = bisect(spans, [begin])
        if k < len(spans) and spans[k][0] == end:
            end = spans.pop(k)[1]
        if k and spans[k - 1][1] == begin:
            begin = spans.pop(k - 1)[0]
            k -= 1
        spans.insert(k, [begin, end])

    def claim(self, width: float, place: Place) -> None:
        """Take the place for a cell ``width`` (um) wide, which is free. Raises StepError where it is not."""
        x, y, orientation = place
        begin, end = round(x / self.site), round((x + width) / self.site)
        spans = self.rows.get((y, orientation), [])
        k = bisect(spans, [begin + 1]) - 1
        if k < 0 or spans[k][1] < end:
            raise StepError(f"no place for a cell of {width:g} um at {x:g}, {y:g} um")
        first, last = spans.pop(k)
        spans[k:k] = [span for span in ([first, begin], [end, last]) if span[0] < span[1]]

    def take(self, width: float, x: float, y: float) -> Place | None:
        """The place for a cell ``width`` wide, which is taken; None if there is none.

        It is nearest to where the cell begins at x, and its middle is at y, um.
        """
        sites, best, least = round(width / self.site), None, float("inf")
        off = {row: abs(row[0] + MIRRORED[row[1]][1] * self.height / 2 - y) for row in self.rows}
        for row in sorted(off, key=lambda row: off[row]):
            if off[row] >= least:
                break
            for k, (begin, end) in enumerate(self.rows[row]):
                at = min(max(round(x / self.site), begin), end - sites)
                far = abs(at * self.site - x) + off[row]
                if at >= begin and far < least:
                    best, least = (row, k, at), far
        if best is None:
            return None
        row, k, at = best
        begin, end = self.rows[row].pop(k)
        self.rows[row][k:k] = [span for span in ([begin, at], [at + sites, end]) if span[0] < span[1]]
        return round(at * self.site, 4), *row

    def filled(self, cells: Mapping[str, float]) -> list[tuple[str, Place]]:
        """Fill cells, of name -> width (um), in all that is free, the widest first."""
        sizes = sorted(((round(width / self.site), name) for name, width in cells.items()), reverse=True)
        made: list[tuple[str, Place]] = []
        for (y, orientation), spans in self.rows.items():
            for at, end in spans:
                for size, name in sizes:
                    while end - at >= size:
                        made.append((name, (round(at * self.site, 4), y, orientation)))
                        at += size
        return made


def free_rows(
    instances: Sequence[Sequence[Any]], widths: Mapping[str, float], fill: Sequence[str], site: float, height: float
) -> Rows:
    """The places of the cells ``fill`` among ``instances``, [number, cell, x, y, orientation]."""
    made = Rows(site, height)
    for _, cell, *place in instances:
        if cell in fill:
            made.give(widths[cell], tuple(place))
    return made
