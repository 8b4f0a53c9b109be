"""The band south of all columns: line drivers, bias, ends of the lanes' lines.

north    ways between the columns, at multiples of their pitch
         the bank's strips          | the bias | its lines' capacitors | the lanes' ends, one strip
south    the chip's pins            | ibias                            | lane_a, lane_b of each lane

All nets between strips, pins and ways are on the fourth metal, each at separate places.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import count, islice
from math import ceil
from typing import NamedTuple

from talbot.base.gds import db
from talbot.models.parameters import ParameterError
from talbot.pixels.analog_layout import flat
from talbot.pixels.analog_layout.array import LOWER_ENCLOSURE, LOWER_TAB, VIA_INSET
from talbot.pixels.analog_layout.cells import Cell
from talbot.pixels.analog_layout.column import PATCH_INSET, draw_patch, steps
from talbot.pixels.analog_layout.column_plan import length_um
from talbot.pixels.analog_layout.comparator import BETWEEN_STRIPS
from talbot.pixels.analog_layout.device import Device, snap
from talbot.pixels.analog_layout.row_driver import legs
from talbot.pixels.analog_layout.strip import (
    FOURTH,
    RAIL_AT,
    RAIL_HALF,
    RAIL_TRUNK,
    SECOND,
    THIRD,
    Strip,
    draw_strip,
    trunk,
)
from talbot.pixels.analog_layout.strip_plan import TRUNK, Placed, Plan, in_columns
from talbot.pixels.circuits.column import BIASES
from talbot.pixels.circuits.column_block import band
from talbot.pixels.circuits.column_sizes import FINGER, ColumnSizes
from talbot.pixels.circuits.netlist import Transistor
from talbot.pixels.layout.canvas import Canvas
from talbot.platforms.analog import AnalogMasks

# um
SOUTH = 4.0  # from the block's edge to the lowest rail
NORTH = 3.0  # from the highest rail to the columns
WEST = 8.0  # of the bank's strips
ROOM = 0.6  # next to each pair of devices
CROSSING_SPACE = 0.95  # least, between centres of lines that cross strips
PARTS_OF = 3  # parts of each of the bias's capacitors, at most
PLATE = 28.0  # width of a part, at most
PLATE_LENGTH = 32.0  # of a row of a part, at most: 900 um2 (capm.12)
ROW_SPACE = 1.5  # between these rows
PLATE_SPACE = 2.0  # between parts, for a way
ENDS_ROOM = 20.0  # of the lanes' ends in the west and in the east
PLATE_RISE = 1.9  # from the rail to a part
RAMP = "bank.clear.ramp"  # the pulse's capacitor, and its net
RAMP_COLUMNS = 1.5, 2.5, 3.5  # x of its net, in columns: between two ways
RAMP_HALF = 4.2  # half the width of its plate's metal
RAMP_TO_WAY = 5.0  # from that metal's middle to a way, at the least
RAMP_STEP = 0.5  # by which the metal moves for a pin
RAMP_WIDTH = 40.0
RAMP_EAST = WEST + 1.0 + RAMP_WIDTH - RAMP_HALF - PATCH_INSET  # greatest x of its net
RAMP_RISE = 1.5  # from the rail
STRIPS = 2  # of the bank
BANK = 500.0  # least east end of the bank
SPARE_WAYS = 1  # places over the bank that no way takes
BIAS_OFFSET = 20.0  # of the bias from there
PLATES_SPACE = 5.0  # from the last capacitor to the lanes' ends
PLATES_OFFSET = 40.0  # of the first capacitor of its lines, at the least

Pair = tuple[Device | None, Device | None]


@dataclass
class Group:
    """Stacked strips.

    rows: n and p transistors of each strip, and its east end.
    ways, pins, inner, plates: x by net of lines to the north, to the south, between strips and to capacitors.
    """

    left: float
    right: float
    rows: Sequence[tuple[Sequence[Placed], Sequence[Placed], float]]
    ways: dict[str, list[float]] = field(default_factory=dict)
    pins: dict[str, float] = field(default_factory=dict)
    inner: dict[str, float] = field(default_factory=dict)
    plates: dict[str, list[float]] = field(default_factory=dict)
    strips: list[Strip] = field(default_factory=list)

    def of(self, net: str) -> list[float]:
        """Return every x of a net."""
        places = [*self.ways.get(net, ()), *self.plates.get(net, ()), self.pins.get(net), self.inner.get(net)]
        return [x for x in places if x is not None]

    def middles(self) -> dict[str, float]:
        """Return the middle of each net."""
        xs: dict[str, list[float]] = {}
        for n, p, _ in self.rows:
            for net, ends in Plan(tuple(n), tuple(p), self.left, self.right, {}).spans().items():
                xs.setdefault(net, []).extend(ends)
        return {net: (min(ends) + max(ends)) / 2 for net, ends in xs.items()}

    def clear(self, x: float) -> bool:
        """Return whether a line at ``x`` is clear of all others."""
        taken = [*(at for xs in self.ways.values() for at in xs), *self.pins.values(), *self.inner.values()]
        taken += [at for xs in self.plates.values() for at in xs]
        return x > self.left and all(abs(x - other) >= CROSSING_SPACE for other in taken)

    def free(self, x: float, step: float, first: float = 0.0) -> float:
        """Return the free place nearest to ``x`` on a grid of ``step``. Raises ParameterError."""
        free = [at for k in range(int(self.right / step + 1e-6) + 1) if self.clear(at := snap(first + step * k))]
        if not free:
            raise ParameterError(f"array.pitch: column band from {self.left:.0f} um must have room for its lines")
        return min(free, key=lambda at: abs(at - x))

    def draw(self, canvas: Canvas, height: float) -> None:
        """Draw the nets between its strips, to the south edge and to ``height``."""
        tracks = [track for strip in self.strips for track in strip.tracks]
        for net in dict.fromkeys(track.net for track in tracks):
            for x in self.of(net):
                beyond = [0.0] if self.pins.get(net) == x else [height] if x in self.ways.get(net, ()) else []
                trunk(canvas, tracks, net, x, *beyond)

    def place(self, canvas: Canvas, masks: AnalogMasks) -> float:
        """Draw the strips; returns the middle of the highest rail."""
        y = SOUTH
        for n, p, _ in self.rows:
            present = {net for device in (*n, *p) for net in device.device.transistor.nodes}
            reach = {net: self.of(net) for net in sorted(present) if self.of(net)}
            plan = Plan(tuple(n), tuple(p), self.left, self.right, reach)
            self.strips.append(draw_strip(canvas, masks, plan, snap(y)))
            y = self.strips[-1].y + self.strips[-1].plan.height_um + BETWEEN_STRIPS
        return y - BETWEEN_STRIPS


@dataclass(frozen=True)
class Band:
    """The drawn band.

    height: um.
    ways: by net, numbers of the columns north of which its lines are.
    """

    cell: Cell
    height: float
    ways: Mapping[str, tuple[int, ...]]
    joints: Mapping[str, Sequence[tuple[float, float, float]]]


def bank_rows(sizes: ColumnSizes, d: Mapping[str, Device]) -> list[list[Pair]]:
    """Return the bank's pairs of devices, in strips of about one length."""
    circuit = next(instance.circuit for instance in band(sizes, 1).instances if instance.name == "bank")
    pairs: list[Pair] = []
    for instance in circuit.instances:
        if instance.name == "clear":  # in the west, below its capacitor
            legs_of_clear = [pair for name in ("over", "clear_n", "clear") for pair in legs(d, f"bank.clear.{name}")]
            pairs = [(d["bank.clear.stay"], d["bank.clear.charge"]), *legs_of_clear, *pairs]
        elif instance.name == "cascodes":
            pairs += [(d[f"bank.cascodes.{name}"], None) for name in ("read", "unread", "second", "none")]
        else:
            pairs += legs(d, f"bank.{instance.name}")
    share = -(-len(pairs) // STRIPS)
    return [pairs[k : k + share] for k in range(0, len(pairs), share)]


def draw_band(
    layout: "db.Layout",
    masks: AnalogMasks,
    sizes: ColumnSizes,
    pitch: float,
    lanes: int,
    pins: Mapping[str, float],
    outward: Sequence[str],
) -> Band:
    """Draw it, its south edge at y = 0.

    pitch: of the columns, um. pins: x of the pins in the south by net. outward: nets that have ways; a lane's two have
    two each. Raises ParameterError.
    """
    d = band_devices(sizes, lanes)
    canvas = Canvas(layout, "column_band", masks.base)
    bank = bank_group(bank_rows(sizes, d), pitch, pins, outward)
    first = snap(min(x for net, x in pins.items() if net.startswith("lane_")) - ENDS_ROOM)
    bias_west = bank.right + BIAS_OFFSET
    bias_row = _bias(d, bias_west)
    plates_of = bias_plates(pitch, bank.right, first, len(_nets(bias_row).intersection(outward)))
    bias_east = plates_of.west + plates_of.pitch * plates_of.parts * len(BIASES) + PLATES_SPACE
    bias = Group(bias_west, bias_east, [bias_row])
    for k, net in enumerate(net for net in BIASES for _ in range(plates_of.parts)):
        bias.plates.setdefault(net, []).append(plates_of.west + (k + 0.5) * plates_of.pitch)
    ends = Group(first, 0.0, [_ends(d, lanes, first)])
    ends.right = snap(ends.rows[0][2] + ENDS_ROOM)
    groups = bank, bias, ends
    for group in groups:
        middles = group.middles()
        group.pins |= {net: x for net, x in pins.items() if net in middles}
        nets_by_x = sorted((net for net in outward if net in middles), key=lambda net: middles[net])
        for k, net in enumerate(nets_by_x):
            for _ in range(2 if net.startswith("lane_") else 1):
                near = middles[net] if group is not bank else WEST + (k + 0.5) / len(nets_by_x) * (bank.right - WEST)
                group.ways.setdefault(net, []).append(group.free(near, plates_of.pitch if group is bias else pitch))
        for net, x in middles.items():
            if sum(net in _nets(row) for row in group.rows) > 1 and not group.of(net):
                group.inner[net] = group.free(x, 0.5, 0.25)
    tops = [group.place(canvas, masks) for group in groups]
    ramp = _ramp(canvas, masks, sizes, bank, tops[0])
    decoupling, top = _decoupling(canvas, masks, sizes, bias, plates_of.width, tops[1])
    plates = ramp, *decoupling
    height = snap(max(tops[0] + RAMP_RISE + ramp.area / RAMP_WIDTH, top) + NORTH)
    joints: dict[str, list[tuple[float, float, float]]] = {"vss": [], "vdd": []}
    for group in groups:
        group.draw(canvas, height)
        _rails(canvas, group.strips, joints)
    terminals = tuple(terminal for group in groups for strip in group.strips for terminal in strip.terminals)
    cell = Cell(canvas.layout, canvas.cell, band(sizes, lanes).ports, tuple(d.values()), plates, terminals)
    ways = {net: [] for net in outward}
    for group in groups:
        for net, xs in group.ways.items():
            ways[net] += [round(x / pitch) for x in xs]
    return Band(cell, height, {net: tuple(xs) for net, xs in ways.items()}, joints)


def bank_group(
    pairs: Iterable[Sequence[Pair]], pitch: float, pins: Mapping[str, float], outward: Iterable[str]
) -> Group:
    """Return the bank, as wide as its ways need, with the place of the ramp's net. Raises ParameterError.

    pairs: of its strips. pitch, pins, outward: as of `draw_band`.
    """
    rows = [in_columns(row, WEST, ROOM) for row in pairs]
    nets = set.union(*map(_nets, rows))
    bank = Group(WEST, BANK, rows, pins={net: x for net, x in pins.items() if net in nets})
    bank.inner[RAMP] = _ramp_um(bank, pitch)
    free = (x for x in (snap(k * pitch) for k in count()) if bank.clear(x))
    bank.right = max(BANK, next(islice(free, len(nets.intersection(outward)) + SPARE_WAYS - 1, None)))
    return bank


class Plates(NamedTuple):
    """Places of the capacitors of the bias's lines, um: width of a part, parts of each.

    pitch: of the parts, between which ways are. west: of the first.
    """

    pitch: float
    west: float
    width: float
    parts: int


def bias_plates(pitch: float, west: float, east: float, ways: int) -> Plates:
    """Return plates between the bank and the lanes' ends, as wide as leaves room for ``ways``. Raises ParameterError.

    pitch: of the columns, um. west, east: ends of both.
    """
    for columns in range(round((PLATE + PLATE_SPACE) / pitch), 0, -1):
        of_part = columns * pitch
        first = ceil((west + PLATES_OFFSET) / of_part) * of_part
        parts = min(PARTS_OF, int((east - PLATES_SPACE - first) / of_part / len(BIASES)))
        last = first + of_part * parts * len(BIASES) + PLATES_SPACE
        if parts > 0 and int(last / of_part) - int((west + BIAS_OFFSET) / of_part) >= ways:
            return Plates(of_part, first, snap(min(PLATE, of_part - PLATE_SPACE)), parts)
    raise ParameterError(f"array.pitch = {1e-6 * pitch:g}: must be less, for the bias west of the lanes")


def _nets(row: tuple[Sequence[Placed], Sequence[Placed], float]) -> set[str]:
    return {net for placed in (*row[0], *row[1]) for net in placed.device.transistor.nodes} - {"vdd", "vss"}


def _bias(d: Mapping[str, Device], left: float) -> tuple[Sequence, Sequence, float]:
    """Return the bias's strip."""
    devices = [device for name, device in d.items() if name.startswith("bias.")]
    n = [device for device in devices if device.transistor.role.startswith("n")]
    p = [device for device in devices if device.transistor.role.startswith("p")]
    count = max(len(n), len(p))
    rows = list(zip([*n, *[None] * (count - len(n))], [*p, *[None] * (count - len(p))], strict=True))
    return in_columns(rows, left, ROOM)


def _ends(d: Mapping[str, Device], lanes: int, left: float) -> tuple[Sequence, Sequence, float]:
    """Return the strip of the lanes' ends, each lane's at its pins."""
    pairs: list[Pair] = []
    for lane in range(lanes):
        for diode in "ab":
            name = f"end_{diode}{lane}."
            pairs += [(d[f"{name}rest_n"], d[f"{name}rest_p"]), (None, d[f"{name}cascode_p"])]
            pairs += [(None, d[f"{name}top"]), (None, d[f"{name}on"])]
    n, p, x = [], [], left
    for k, pair in enumerate(pairs):
        more_n, more_p, end = in_columns([pair], x, ROOM)
        n += more_n
        p += more_p
        x = snap(left + (k // 8 + 1) * 100.0) if k % 8 == 7 else end
    return tuple(n), tuple(p), max(placed.high for placed in (*n, *p))


def _rails(canvas: Canvas, strips: Sequence[Strip], joints: dict[str, list[tuple[float, float, float]]]) -> None:
    """Join the rails of strips above each other: the ground's in the west, the supply's in the east."""
    right = max(strip.plan.right for strip in strips)
    for net, x in (("vss", strips[0].plan.left - RAIL_AT), ("vdd", right + RAIL_AT)):
        ys = [strip.y + (strip.plan.height_um if net == "vdd" else 0.0) for strip in strips]
        half = RAIL_TRUNK / 2
        canvas.wire(FOURTH, x - half, min(ys) - half, x + half, max(ys) + half)
        for strip, y in zip(strips, ys, strict=True):
            canvas.wire(
                1, min(strip.plan.right, x) - half, y - RAIL_HALF, max(x, strip.plan.left) + half, y + RAIL_HALF
            )
            for level in (SECOND, THIRD):
                canvas.wire(level, x - half, y - RAIL_HALF, x + half, y + RAIL_HALF)
            for side in (-0.25, 0.25):
                canvas.stack(x + side, y, 1, FOURTH)
        joints[net].append((x, min(ys) - half, max(ys) + half))


def band_devices(sizes: ColumnSizes, lanes: int) -> dict[str, Device]:
    """All transistors of a band."""
    return {t.name: _device(t) for t in flat.transistors(band(sizes, lanes))}


def _device(t: Transistor) -> Device:
    """Return a transistor in fingers whose contacts are on the grid."""
    device = Device.of(t)
    return device if round(device.finger_um / 0.005) % 2 == 0 else Device.of(t, FINGER)


def _ramp_um(bank: Group, pitch: float) -> float:
    """Return x of the ramp's net: its plate's metal is between two ways, its line clear of the pins."""
    by_steps = [RAMP_STEP * k for k in range(int((pitch / 2 - RAMP_TO_WAY) / RAMP_STEP) + 1)]
    places = (snap(columns * pitch + side * by) for columns in RAMP_COLUMNS for by in by_steps for side in (-1, 1))
    place = next((x for x in places if x <= RAMP_EAST and bank.clear(x)), None)
    if place is None:
        raise ParameterError(f"array.pitch = {1e-6 * pitch:g}: must have room for a line between the bank's pins")
    return place


def _ramp(canvas: Canvas, masks: AnalogMasks, sizes: ColumnSizes, bank: Group, top: float) -> flat.Plate:
    """The pulse's capacitor, above the bank's west: its upper plate's metal between two ways, the lower at ground."""
    pulse = next(c for c in flat.capacitors(band(sizes, 1)) if c.name == RAMP)
    left, low, high = WEST + 1.0, top + RAMP_RISE, snap(top + RAMP_RISE + length_um(pulse.value, masks, RAMP_WIDTH))
    canvas.box(masks.mim, left, low, left + RAMP_WIDTH, high)
    ground = WEST - RAIL_AT
    canvas.wire(THIRD, ground - 0.5, low - LOWER_ENCLOSURE, left + RAMP_WIDTH + LOWER_ENCLOSURE, high + LOWER_ENCLOSURE)
    canvas.wire(FOURTH, ground - 0.5, SOUTH, ground + 0.5, high)
    for y in steps(low, high):
        canvas.square(masks.base.vias[THIRD].gds, ground, y, 0.2)
    at = bank.inner[RAMP]
    draw_patch(canvas, at - RAMP_HALF, low + PATCH_INSET, at + RAMP_HALF, high - PATCH_INSET)
    track = next(piece for strip in bank.strips for piece in strip.tracks if piece.net == RAMP)
    canvas.wire(FOURTH, at - TRUNK / 2, track.y, at + TRUNK / 2, low + 1)
    return flat.Plate(RAMP, RAMP, "vss", RAMP_WIDTH * (high - low), 2 * (RAMP_WIDTH + high - low))


def _decoupling(
    canvas: Canvas, masks: AnalogMasks, sizes: ColumnSizes, bias: Group, wide: float, top: float
) -> tuple[list[flat.Plate], float]:
    """Return the capacitors of the bias's lines, between the places of ways above its strip, and their top.

    wide: um, of a part.
    """
    strip, plates, highest = bias.strips[0], list[flat.Plate](), top
    tracks = {track.net: track.y for track in strip.tracks}
    for c in (c for c in flat.capacitors(band(sizes, 1)) if c.name.startswith("bias.c_")):
        low, parts = top + PLATE_RISE, len(bias.plates[c.a])
        whole = length_um(c.value / parts, masks, wide)
        rows = ceil(whole / PLATE_LENGTH)
        piece = length_um(c.value / parts / rows, masks, wide)
        high = snap(low + rows * piece + (rows - 1) * ROW_SPACE)
        highest = max(highest, high)
        for middle in bias.plates[c.a]:
            left = middle - wide / 2
            canvas.wire(
                THIRD, left - LOWER_ENCLOSURE, low - LOWER_TAB, left + wide + LOWER_ENCLOSURE, high + LOWER_ENCLOSURE
            )
            for row in range(rows):
                y = snap(low + row * (piece + ROW_SPACE))
                canvas.box(masks.mim, left, y, left + wide, snap(y + piece))
                patch = left + PATCH_INSET, y + PATCH_INSET, left + wide - PATCH_INSET, snap(y + piece - PATCH_INSET)
                draw_patch(canvas, *patch)
            canvas.wire(FOURTH, middle - TRUNK / 2, tracks[c.a] - TRUNK / 2, middle + TRUNK / 2, high - 1)
            rail, at = (top if c.b == "vdd" else strip.y), middle + 3.0
            canvas.stack(at, low - VIA_INSET, SECOND, THIRD)
            canvas.wire(SECOND, at - 0.19, rail - 0.19, at + 0.19, low - VIA_INSET + 0.19)
            canvas.stack(at, rail, 1, SECOND)
        count = parts * rows
        plates.append(flat.Plate(c.name, c.a, c.b, count * wide * piece, count * 2 * (wide + piece)))
    return plates, highest
