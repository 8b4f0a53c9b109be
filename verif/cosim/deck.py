"""The circuit of a row: netlist, and drive of each switch."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial

from talbot.cells.corner import Corner
from talbot.models.parameters import check_real
from talbot.pixels.circuits import lane as lanes_of
from talbot.pixels.circuits.amplifier import AmplifierSizes, AmplifierSpec
from talbot.pixels.circuits.column_sizes import ColumnSpec, size
from talbot.pixels.circuits.gates import LENGTH, inverter
from talbot.pixels.circuits.netlist import Circuit, Instance, Transistor
from talbot.pixels.circuits.specification import CODES, LaneSpec
from talbot.platforms.sky130 import analog
from talbot.verif.cosim import amplified, extracted, pixels
from talbot.verif.cosim import columns as own_columns
from talbot.verif.cosim.accuracy import Accuracy
from talbot.verif.cosim.faults import Fault

SUBS = 4  # sub-samples of a column, as in front_end.sv
BITS = 8
MIDDLE = CODES // 2
CORNER = Corner("tt", 25.0, 1.8)
SELECT_W = 16.0  # um, n transistor between a column and its lane: 4.3 pF settle in a cycle
LANE_NODES = ("top", "other", "xcomparator.outp", "xcomparator.outn")  # in the waves
Values = Mapping[tuple[int, int], float]


@dataclass(frozen=True)
class RowOfPixels:
    """Pixels of a row.

    diodes: (a, b) in LSB of each column and tap; cols: of the array; integration: s. amplified: both diodes' samples go
    to the lanes' amplifiers, else their difference or sum to the lanes. columns: the column amplifiers are transistors.
    """

    diodes: Mapping[int, Mapping[int, tuple[float, float]]]
    cols: int
    gain: float
    integration: float
    sizes: pixels.PixelSizes = pixels.PixelSizes()
    amplified: bool = False
    columns: bool = False


@dataclass(frozen=True)
class Timing:
    """Clock period (1e-9..1), its time high (1e-9..period), length of every ramp (1e-12..1e-9), all in s.

    The chip lets a lane hold the next value in the cycle of its last decision: a lane whose DAC samples must decide
    first. `sample` is thus high while clk is low in hold's cycle, from ``after`` (s from the strobe, 0..1e-8) on.
    """

    period: float = 100e-9
    edge: float = 100e-12
    after: float = 5e-9
    high: float = 50e-9

    def __post_init__(self) -> None:
        check_real("period", self.period, 1e-9, 1.0)
        check_real("edge", self.edge, 1e-12, 1e-9)
        check_real("after", self.after, 0.0, 1e-8)
        check_real("high", self.high, 1e-9, self.period)


@dataclass
class Deck:
    """A netlist and its drive: of all lanes, or of one and its columns.

    answers: of each lane of the chip, the node of its decision, or "-". lanes, columns: those that are simulated.
    lines: of the netlist. drive: those of +drive below its head. saved: nodes of the waves. supply: V. flat: lanes are
    as extracted, without circuits in them. repeated: of the columns' trim, transients that needed a retry.
    """

    answers: list[str]
    lanes: tuple[int, ...]
    columns: tuple[int, ...]
    lines: list[str] = field(default_factory=list)
    drive: list[str] = field(default_factory=list)
    saved: list[str] = field(default_factory=list)
    sources: list[str] = field(default_factory=list)
    transistors: int = 0
    supply: float = 1.8
    flat: bool = False
    repeated: int = 0

    def inside(self, lane: int) -> tuple[str, ...]:
        """Names of LANE_NODES of a lane in the waves."""
        return tuple(f"xlane{lane}.{node.removeprefix('x') if self.flat else node}" for node in LANE_NODES)


def build(
    values: Values,
    lanes: int,
    tile_cols: int,
    unsigned: bool,
    spec: LaneSpec,
    timing: Timing,
    accuracy: Accuracy,
    fault: Fault | None = None,
    everything: bool = False,
    row: "RowOfPixels | None" = None,
    drawn: bool = False,
    mode: str = "",
) -> Deck:
    """Return the circuit that reads one row.

    values: LSB at (column, sub-sample). lanes: of the chip; only those that serve one of these columns are built, with
    ``everything`` all. unsigned: the range of all values; else -128..127. row: pixels instead of ideal columns. drawn:
    circuits as drawn and extracted; without ``fault``. mode: of the row with columns in transistors.
    """
    columns = tuple(sorted({column for column, _ in values}))
    used = {column // tile_cols % lanes for column in columns}
    served = tuple(sorted(range(lanes) if everything else used))
    deck = Deck(
        [f"q{i}" if i in served else "-" for i in range(lanes)], served, columns, supply=spec.supply, flat=drawn
    )
    sizes = lanes_of.size(spec, analog)
    sound = lanes_of.sar_lane(sizes)
    body, own = [], []
    circuits = {"selector": _selector()}
    amplifier = amplified.sized("sky130", spec, sizes) if row and row.amplified else None
    if amplifier:
        circuits |= {one.name: one for one in amplified.circuits(amplifier[1])}
    charges = row is not None and row.columns  # the columns have amplifiers of their own
    second = _source(deck, "second", spec.supply, _second(lanes, row.cols)) if row and mode == "raw" else ""
    if amplifier and not charges:
        body.append(f"Vdark column_dark 0 {amplifier[0].reset_level:g}")
    for i in served:
        one = fault.of_lane(sound, i) if fault else sound
        circuits[one.name] = one
        bits = [_source(deck, f"d{i}_{k}", spec.supply, lanes + BITS * i + k) for k in range(BITS)]
        pins = [
            *(f"in{i}", "ref", _source(deck, f"sample{i}", spec.supply, i, half=True, rise=timing.after)),
            _source(deck, f"strobe{i}", spec.supply, 9 * lanes + i, half=True),
            *(*reversed(bits), f"q{i}", "refp", "refn", "vcm", "vdd", "0"),
        ]
        body += [f"Xlane{i} {' '.join(pins)} {one.name}", f"Cin{i} in{i} 0 50f"]
        deck.saved += [f"q{i}", f"in{i}", *deck.inside(i)]
        if amplifier:
            body += amplified.lane_lines(i, partial(_source, deck), spec.supply, not charges, second)
            deck.saved += [f"cola{i}", f"colb{i}"]
    level = 0.5 * (spec.refp + spec.refn)
    for (column, sub), value in sorted(values.items()) if not charges else ():
        name, into = f"{column}_{sub}", column // tile_cols % lanes
        # The chip's position is stable for a cycle after hold. A switch that opens with the lane's sample leaves its
        # charge in it: 0.66 LSB at value 40
        rise, fall = amplified.COLUMNS if amplifier else 0.0, amplified.AFTER
        on = _source(deck, f"select{name}", spec.supply, 10 * lanes + SUBS * column + sub, rise=rise, fall=fall)
        ways = [(f"{d}{name}", f"col{d}{into}") for d in "ab"] if amplifier else [(name, f"in{into}")]
        body += [f"Xselect{one} column{one} {to} {on} vdd 0 selector" for one, to in ways]
        if row is None:
            body.append(f"Vcolumn{name} column{name} 0 {level + (value - MIDDLE * unsigned) * spec.lsb:.9g}")
    if row is not None and row.columns:
        circuits |= _columns(deck, body, row, mode, spec, lanes, tile_cols, timing, fault)
    elif row is not None:
        circuits |= {one.name: one for one in (pixels.pixel(row.sizes.well), pixels.clear(), pixels.sampler())}
        own = pixels.amplifier(row.sizes)
        body += _row(deck, row, unsigned, spec, level, amplifier, fault)
        deck.saved += [f"out_{d}{c}" for c in columns for d in "ab"]
        first = 10 * lanes + SUBS * row.cols
        for i, line in enumerate((*pixels.LINES, "clear")):
            _source(deck, f"{line}_row", spec.supply, first + i)
        for tap in range(SUBS):
            _source(deck, f"tap{tap}", spec.supply, first + 3 + tap)
            _source(deck, f"light{tap}", 1.0, -1)
    layouts = extracted.circuits() if drawn else {}
    circuits |= {name: layouts[name] for name in circuits.keys() & layouts.keys()}
    if not fault:
        for circuit in circuits.values():
            circuit.check(analog)
    all_sizes = set().union(*(circuit.sizes() for circuit in circuits.values()))
    called = [line.split()[-1] for line in body if line[0] == "X"]
    deck.transistors = sum(_count(circuits["charge_clear" if name == "charge" else name]) for name in called)
    supplies = {"refp": spec.refp, "refn": spec.refn, "vcm": spec.vcm, "ref": level}
    deck.saved.append("ref")
    deck.lines = [
        "* one row of a sensor",
        *accuracy.options,
        f".temp {CORNER.temperature:g}",
        *accuracy.cards(analog.cards(CORNER.process, all_sizes)),
        ".param cscale=1 rscale=1",
        *dict.fromkeys(text for circuit in circuits.values() for text in _subcircuits(circuit)),
        *own,
        f"Vdd vdd 0 {spec.supply:g}",
        *(f"V{name} {name}_out 0 {volts:g}" for name, volts in supplies.items()),
        *(f"R{name} {name}_out {name} {spec.reference_resistance:g}" for name in supplies),
        *deck.sources,
        *extracted.as_drawn(body, layouts),
        ".save " + " ".join(f"v({node})" for node in deck.saved),
        ".end",
    ]
    return deck


def _columns(
    deck: Deck,
    body: list[str],
    row: RowOfPixels,
    mode: str,
    spec: LaneSpec,
    lanes: int,
    tile_cols: int,
    timing: Timing,
    fault: Fault | None,
) -> dict[str, Circuit]:
    """Lines of the pixels and their column amplifiers in transistors into ``body``; what they call."""
    column = ColumnSpec.of()
    sizes = size(column, analog)
    swapped = frozenset(fault.where if fault and fault.kind == "diodes" else ())
    cut = fault.where[0] if fault and fault.kind == "row" else None
    trim = own_columns.trimmed(column, mode in own_columns.BOTH, timing.period, spec.supply, deck.flat)
    deck.repeated = trim.repeated
    taps = {c: row.diodes[c] for c in deck.columns}
    of_lane = {c: c // tile_cols % lanes for c in deck.columns}
    given = (mode, row.integration, column, sizes, row.sizes, trim, row.cols, swapped, cut)
    body += own_columns.lines(taps, of_lane, *given)
    body += [own_columns.amplifier_bias(lane, trim.rest) for lane in deck.lanes]
    first = 10 * lanes + SUBS * row.cols
    own_columns.drive(partial(_source, deck), deck.columns, deck.lanes, first, row.cols, spec.supply)
    deck.saved += [f"xcolumn{c}.out_{d}" for c in deck.columns for d in "ab"]
    return {one.name: one for one in own_columns.circuits(column, sizes)}


def _row(
    deck: Deck,
    row: RowOfPixels,
    unsigned: bool,
    spec: LaneSpec,
    level: float,
    amplifier: tuple[AmplifierSpec, AmplifierSizes] | None,
    fault: Fault | None,
) -> list[str]:
    """Lines of the pixels and columns."""
    columns = {c: row.diodes[c] for c in deck.columns}
    middle = level - MIDDLE * unsigned * spec.lsb
    if amplifier:
        volts = amplified.column_volts(spec, amplifier[1], row.gain)
        forms = {d: (amplifier[0].reset_level, {d: -volts}) for d in "ab"}
    else:
        a, b = (row.gain, -row.gain) if not unsigned else (1.0, 1.0)
        forms = {"": (middle, {"a": a * spec.lsb, "b": b * spec.lsb})}
    swapped = frozenset(fault.where if fault and fault.kind == "diodes" else ())
    cut = fault.where[0] if fault and fault.kind == "row" else None
    return pixels.lines(columns, forms, row.integration, row.sizes, row.cols, swapped, cut)


def _subcircuits(circuit: Circuit) -> list[str]:
    """Return each of a circuit's subcircuits as a text, so that shared ones are written a single time."""
    texts: list[list[str]] = []
    for line in circuit.lines(analog):
        if line.startswith(".subckt"):
            texts.append([])
        texts[-1].append(line)
    return ["\n".join(text) for text in texts]


def _count(circuit: Circuit) -> int:
    """Transistors in a circuit and those inside it."""
    return len(circuit.transistors) + sum(_count(one.circuit) for one in circuit.instances)


def _source(
    deck: Deck,
    name: str,
    high: float,
    bit: int,
    half: bool = False,
    rise: float = 0.0,
    fall: float = 0.0,
    low: float = 0.0,
) -> str:
    """Add a control, ``low`` or ``high`` V where its bit is 0 or 1; returns its node.

    half: while clk is low alone. rise, fall: s by which its changes to 1 and to 0 are late.
    """
    deck.sources.append(f"V{name} {name} 0 external")
    deck.drive.append(f"v{name} {bit} {low:g} {high:g} {int(half)} {rise:.9g} {fall:.9g}")
    return name


def _second(lanes: int, cols: int) -> int:
    """Return the last bit of the controls of front_end.sv: the second sub-sample is at the pins."""
    return 10 * lanes + SUBS * cols + 3 + SUBS + 2 + 4 * SUBS + cols


def _selector() -> Circuit:
    """Return the switch from a column to its lane. Pins: a b on vdd vss."""
    through = (
        Transistor("n", "a", "on", "b", "vss", "n_lvt", SELECT_W, LENGTH),
        Transistor("p", "a", "off", "b", "vdd", "p_lvt", 2 * SELECT_W, 0.35),
    )
    off = Instance("off", inverter(2), ("on", "off", "vdd", "vss"))
    return Circuit("selector", ("a", "b", "on", "vdd", "vss"), through, instances=(off,))
