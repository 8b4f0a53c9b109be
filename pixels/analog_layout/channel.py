"""A channel: nets on tracks of the third metal, between terminals below and above it.

    above    the fourth metal again, from the second by vias in the channel's upper edge
             ... | ... second metal
             ----+----- a track: one net, or several side by side
                 ... | ... fourth metal
    below    the fourth metal

So nets meet on no metal, wherever their ends are.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from talbot.pixels.analog_layout.strip import FOURTH, SECOND, THIRD, TRACK
from talbot.pixels.analog_layout.strip_plan import TRACK_PITCH, TRUNK
from talbot.pixels.layout.canvas import Canvas

NET_SPACE = 1.0  # um, between nets on a track
RISER_WIDTH = 0.3  # um, of the segment from a track to the channel's upper edge
TOP_MARGIN = 3.0  # um, from the last track to the upper edge
VIA_DEPTH = 1.2  # um, of the vias below the upper edge
PAD_HALF = 0.3  # um, half the third metal there
LEAST_WIRE = 0.64  # um, of third metal as wide as a track: its least area
Row = list[tuple[str, float, float]]


@dataclass(frozen=True)
class Channel:
    """Nets and, of each, x of its ends below and above, um. y: of the channel's lower edge, um."""

    y: float
    below: Mapping[str, Sequence[float]]
    above: Mapping[str, Sequence[float]]

    @property
    def rows(self) -> list[Row]:
        """(net, left, right) on every track, from the lowest."""
        ends = {net: [*self.below.get(net, ()), *self.above.get(net, ())] for net in {**self.below, **self.above}}
        spans = {net: (min(xs), max(xs)) for net, xs in ends.items()}
        rows: list[Row] = []
        for net in sorted(spans, key=lambda net: (spans[net], net)):
            left, right = spans[net]
            row = next(
                (row for row in rows if all(right + NET_SPACE < a or b + NET_SPACE < left for _, a, b in row)), None
            )
            if row is None:
                row = []
                rows.append(row)
            row.append((net, left, right))
        return rows

    @property
    def top(self) -> float:
        """Return y of its upper edge."""
        return self.y + TRACK_PITCH * len(self.rows) + TOP_MARGIN

    def draw(self, canvas: Canvas, bottom: float, ends: Mapping[float, float] | None = None) -> None:
        """Draw it. bottom: y at which what comes from below begins. ends: y up to which what is above leads, by x."""
        half, top = TRACK / 2, self.top
        for number, row in enumerate(self.rows):
            y = self.y + TRACK_PITCH * (number + 0.5)
            for net, left, right in row:
                long = max(right - left + 2 * half, LEAST_WIRE) / 2
                middle = (left + right) / 2
                canvas.wire(THIRD, middle - long, y - half, middle + long, y + half)
                for x in self.below.get(net, ()):
                    canvas.wire(FOURTH, x - half, bottom, x + half, y + half)
                    canvas.stack(x, y, THIRD, FOURTH)
                for x in self.above.get(net, ()):
                    canvas.wire(SECOND, x - RISER_WIDTH / 2, y - half, x + RISER_WIDTH / 2, top - VIA_DEPTH)
                    canvas.stack(x, y, SECOND, THIRD)
                    up(canvas, x, top - VIA_DEPTH)
                    end = (ends or {}).get(x, top + 0.1)
                    canvas.wire(FOURTH, x - TRUNK / 2, top - VIA_DEPTH - PAD_HALF, x + TRUNK / 2, end)


def up(canvas: Canvas, x: float, y: float) -> None:
    """Vias from the second to the fourth metal."""
    canvas.stack(x, y, SECOND, FOURTH)
    canvas.wire(THIRD, x - PAD_HALF, y - PAD_HALF, x + PAD_HALF, y + PAD_HALF)
