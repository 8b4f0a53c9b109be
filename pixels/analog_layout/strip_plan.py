"""A strip before it is drawn: its transistors in two rows, and the tracks of its nets."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from talbot.pixels.analog_layout.device import RAIL, Device, Strap

# um
GAP = 0.40  # between adjacent diffusions
ROW_SPACE = 1.5  # between the diffusions of the two rows
TRACK_PITCH = 0.70
TRACK_IN = 0.85  # from a rail's centre to the first track
DROP_PITCH = 0.52
OPEN_ENDS = 0.72  # beyond a single row's gates
TRUNK = 0.5  # um, width of a net from strip to strip
SPLIT = 0.2  # from the axis to the halves of tracks
CROSS = 0.9  # from the axis to their crossing


@dataclass(frozen=True)
class Placed:
    """A device whose diffusion begins at ``x`` (um); its straps may be from ``low`` to ``high``."""

    device: Device
    x: float
    low: float
    high: float


@dataclass(frozen=True)
class Plan:
    """A strip before it is drawn.

    n, p: its rows.
    left, right: its ends, um.
    through: by net, x to which the tracks of nets that meet other strips reach.
    split, twisted: pairs of nets that are mirror images, the western one first.
    axis: of its symmetry, or None.
    rails: nets without tracks, the lower rail's first.
    quiet: nets whose tracks are grouped, away from the others.
    least_um: smallest height.
    fixed: rows of nets that continue in other strips at the same height.
    least_rows: smallest number of tracks.
    track_in: um from a rail's centre to the first track.
    """

    n: tuple[Placed, ...]
    p: tuple[Placed, ...]
    left: float
    right: float
    through: Mapping[str, Sequence[float]]
    split: tuple[tuple[str, str], ...] = ()
    twisted: tuple[tuple[str, str], ...] = ()
    axis: float | None = None
    rails: tuple[str, ...] = ("vss", "vdd")
    quiet: frozenset[str] = frozenset()
    least_um: float = 0.0
    fixed: Mapping[str, int] = field(default_factory=dict)
    least_rows: int = 0
    track_in: float = TRACK_IN

    @property
    def height_um(self) -> float:
        """Return the distance between the rails' centres."""
        heights = [max((placed.device.finger_um for placed in row), default=0.0) for row in (self.n, self.p)]
        between = ROW_SPACE if self.n and self.p else OPEN_ENDS
        devices = 2 * RAIL + sum(heights) + between
        return max(devices, 2 * self.track_in + TRACK_PITCH * (len(self._rows()) - 1), self.least_um)

    def placed(self) -> tuple[Placed, ...]:
        """All devices."""
        return (*self.n, *self.p)

    def spans(self) -> dict[str, tuple[float, float]]:
        """(left, right) of every net's track that there may be a drop on, um."""
        by_net: dict[str, tuple[float, float]] = {}
        for placed in self.placed():
            t = placed.device.transistor
            for net in [net for net in dict.fromkeys((t.drain, t.gate, t.source)) if net not in self.rails]:
                left, right = by_net.get(net, (placed.low, placed.high))
                by_net[net] = min(left, placed.low), max(right, placed.high)
        for net, reached in self.through.items():
            ends = [x + side * TRUNK / 2 for x in reached for side in (-1, 1)]
            by_net[net] = min([*by_net[net][:1], *ends]), max([*by_net[net][1:], *ends])
        if self.axis is not None:
            by_net = {net: (min(a, 2 * self.axis - b), max(b, 2 * self.axis - a)) for net, (a, b) in by_net.items()}
        return by_net

    def _rows(self) -> list[list[tuple[str, float, float]]]:
        """(net, left, right) of what is on each track, from the first track on."""
        spans, rows = self.spans(), list[list[tuple[str, float, float]]]()
        for pair in (*self.split, *self.twisted):
            left, right = min(spans[net][0] for net in pair), max(spans[net][1] for net in pair)
            away, axis = SPLIT if pair in self.split else CROSS, self.axis or 0.0
            ends = (left, axis - away), (axis + away, right)
            for nets in (pair, pair[::-1])[: 1 if pair in self.split else 2]:
                rows.append([(net, *end) for net, end in zip(nets, ends, strict=True)])
        paired = {net for pair in (*self.split, *self.twisted) for net in pair}
        rows += [[] for _ in range(self.least_rows - len(rows))]
        for net in sorted(self.fixed.keys() & spans.keys()):
            rows[self.fixed[net]].append((net, *spans[net]))
        paired |= self.fixed.keys()
        for kind in (spans.keys() & self.quiet - paired, spans.keys() - self.quiet - paired):
            fixed = 0 if self.least_rows else len(rows)
            for net in sorted(kind, key=lambda net: (spans[net][0] - spans[net][1], net)):
                a, b = spans[net]
                fitting = (row for row in rows[fixed:] if all(b + 1 < c or d + 1 < a for _, c, d in row))
                row = next(fitting, None)
                if row is None:
                    row = []
                    rows.append(row)
                row.append((net, a, b))
        return rows

    def tracks(self) -> list[Strap]:
        """Tracks by their height over the lower rail, um: spread about the middle."""
        rows = self._rows()
        first = self.height_um / 2 - TRACK_PITCH * (len(rows) - 1) / 2
        return [Strap(net, a, b, first + TRACK_PITCH * k) for k, row in enumerate(rows) for net, a, b in row]


def in_columns(
    columns: Sequence[tuple[Device | None, Device | None]], left: float, room: float = 0.0
) -> tuple[tuple[Placed, ...], tuple[Placed, ...], float]:
    """Rows of (n, p) above each other from ``left`` on; room: more between them. Returns the rows and the east end."""
    n, p, x = list[Placed](), list[Placed](), left
    for pair in columns:
        present = [device for device in pair if device]
        straps = sum(3 - (d.transistor.source == d.transistor.bulk) for d in present)
        width = max(*(d.width_um + GAP for d in present), straps * DROP_PITCH + room, 0.0)
        for device, row in zip(pair, (n, p), strict=True):
            if device:
                row.append(Placed(device, on_grid(x + (width - device.width_um) / 2), x, x + width))
        x = on_grid(x + width)
    return tuple(n), tuple(p), x


def mirrored(
    middle: Device | None, outward: Sequence[tuple[Device, Device]], axis: float, room: float = 0.0
) -> tuple[Placed, ...]:
    """Return a row about ``axis``: a device on it, and pairs (west, east) from there outwards."""
    placed, x = list[Placed](), 0.0
    if middle:
        x = on_grid(max(middle.width_um + GAP, 3 * DROP_PITCH) / 2)
        placed.append(Placed(middle, axis - middle.width_um / 2, axis - x, axis + x))
    for west, east in outward:
        width = max(west.width_um + GAP, 3 * DROP_PITCH) + room
        width, inner = on_grid(width), on_grid((width - west.width_um) / 2)
        placed.append(Placed(east, axis + x + inner, axis + x, axis + x + width))
        placed.append(Placed(west, axis - x - inner - west.width_um, axis - x - width, axis - x))
        x += width
    return tuple(placed)


def on_grid(um: float) -> float:
    """Return the nearest multiple of 0.005 um."""
    return round(um / 0.005) * 0.005
