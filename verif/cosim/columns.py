"""The column amplifiers of one row in transistors, for the deck of a co-simulation: pixels/circuits/column.py.

Their lines are driven as the block's bank drives them, its gates' delays as delays of the drive; the pulse that ends by
itself is the bank's own circuit. Row lines have 3.3 V, wells are reset to the level of the block's bias.
"""

from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from typing import NamedTuple

import numpy as np

from talbot.cells.spice.engine import Simulator
from talbot.models.parameters import DIODE, ELEMENTARY_CHARGE, AmpTiming
from talbot.pixels.circuits.column import BIASES, PINS, TAPS, block_line, column
from talbot.pixels.circuits.column_block import OUTSIDE, cascode_lines, clear_pulse, column_bias, lane_end, lane_line
from talbot.pixels.circuits.column_sizes import ColumnSizes, ColumnSpec, size
from talbot.pixels.circuits.netlist import Circuit
from talbot.pixels.circuits.row_driver import THICK
from talbot.pixels.circuits.specification import CODES
from talbot.pixels.circuits.support import bias
from talbot.pixels.datasheet.amplifier import COLUMNS, EXACT
from talbot.pixels.datasheet.column import GAP, ROW, SETTLED, nearer
from talbot.platforms.sky130 import analog
from talbot.verif.cosim import extracted
from talbot.verif.cosim.accuracy import Accuracy
from talbot.verif.cosim.amplified import AFTER, Drive
from talbot.verif.cosim.pixels import PixelSizes, pixel, row_line

TIMING = AmpTiming()  # of a row with these columns: the holder has 16 cycles in each half
CELSIUS = 25.0
# A row's. With 0.1 pA and a reltol of 1e-5 no time step converged after a control's edge
CURRENT = f".option abstol={Accuracy().abstol:g}"
LINE, CIN = 0.5, 1.2  # V of a column's line and coupling capacitors as the first step of a trim begins
# Of the trim: as drawn a lane follows `start` by 1.15 of what the circuit's does. It is 5 mV off after one, after three
# the second diode's is 0.12 mV off, 0.13 LSB of a difference
STEPS = 4
# F of a column at `clear`, as drawn: 14.7 fF of wires and two gates. Its fall reaches the first diode's output, and the
# faster the more: with two columns more in the deck a sample was 0.6 LSB off
CLEAR_FARAD = 16e-15
SOURCE = "vbn", "vbp", "source", "start", "part_1", "part_2", "part_3"  # nodes of a bias
RESTING = (*BIASES, "level", "ibias_columns", *(f"xcolumn_source.{name}" for name in SOURCE))
BIAS = (
    "Xcolumn_source ibias_columns vdd 0 bias",
    f"Xcolumn_bias ibias_columns {' '.join(BIASES)} level vdd 0 column_bias",
)
NO_TRANSIENT = ".control", "optran 1 1 1 0 0 0", ".endc"  # for an operating point: what is to begin elsewhere would not


BOTH = "edge", "raw"  # modes in which both diodes of a column drive their lanes


class Trim(NamedTuple):
    """Result of a trim.

    start: V of start_a and start at which a pixel without light leaves its lanes at dark. rest: V of RESTING and vdd.
    column: V that this leaves at line_a, line_b and every net of a column. repeated: of the transients, those that
    needed a retry.
    """

    start: tuple[float, float]
    rest: Mapping[str, float]
    column: Mapping[str, float]
    repeated: int


def circuits(spec: ColumnSpec, sizes: ColumnSizes) -> tuple[Circuit, ...]:
    """Subcircuits that the lines of a deck call."""
    parts = column(sizes), column_bias(sizes), clear_pulse(sizes), lane_end(sizes), lane_line(sizes, spec), bias()
    return (*parts, cascode_lines(), pixel(spec.well, "n_thick", THICK))


def lines(
    diodes: Mapping[int, Mapping[int, tuple[float, float]]],
    lanes: Mapping[int, int],
    mode: str,
    integration: float,
    spec: ColumnSpec,
    sizes: ColumnSizes,
    pixels: PixelSizes,
    trim: Trim,
    cols: int = 1,
    swapped: frozenset[int] = frozenset(),
    cut: int | None = None,
) -> list[str]:
    """Lines of the deck; see `drive` for their controls. lanes: of each column; the lanes' lines end at cola0, colb0.

    diodes: (a, b) in LSB of each column and tap. mode: in edge and raw lanes get both diodes, else the mean. trim:
    initial voltages: an operating point of these floating nodes takes minutes, and what rises from 0 V couples into the
    others (as drawn 0.5 LSB of a sum). cols: that the row's lines pass. swapped: columns whose diodes are on each
    other's line. cut: column from which on the row's read line is open.
    """
    edge = mode in BOTH
    own = {"edge": "vdd" if edge else "0", "edgen": "0" if edge else "vdd", "k": "vdd", "vss": "0", "ref": "row_ref"}
    deck = [
        *(f"V{name} {name} 0 {volts:.9g}" for name, volts in levels(mode, spec).items()),
        *(f"V{name} {name} 0 {volts:.9g}" for name, volts in zip(("start_a", "start"), trim.start, strict=True)),
        begun(trim.rest),
        *(f"Coutside_{name} {name} 0 {OUTSIDE:g}" for name in (*BIASES, "level")),
        *BIAS,
        f"Xcascodes vcn reads readsn {own['edge']} {own['edgen']} cn vcnb 0 cascode_lines",
        "Xclear row_ref row_refn clear vbp vdd 0 clear_pulse",
        f"Cclear clear 0 {(spec.array - len(diodes)) * CLEAR_FARAD:.9g}",  # columns that the row does not read
    ]
    for lane in sorted(set(lanes.values())):
        for d, reference in (("a", "reference"), ("b", "dark")):
            turn = f"turn{lane} turnn{lane}" if d == "a" or edge else "0 vdd"
            deck.append(f"Xend{d}{lane} col{d}{lane} {reference} {turn} vbl vcp vdd 0 lane_end")
            deck.append(f"Xlines{d}{lane} lane{d}{lane} sense{d}{lane} col{d}{lane} 0 lane_line")
    places = [str(c) for c in range(cols)]
    deck += [*row_line("reset", places, pixels), *row_line("read", places, pixels, str(cut))]
    for c, taps in diodes.items():
        names = ("b", "a") if c in swapped else ("a", "b")
        ends = " ".join(f"line_{d}{c}" for d in names)
        deck.append(f"Xpixel{c} well_a{c} well_b{c} {ends} reset{c} read{c} level 0 pixel")
        deck += [f"Cline_{d}{c} line_{d}{c} 0 {spec.line:g}" for d in "ab"]
        deck.append(begun({_of_column(net, c): volts for net, volts in trim.column.items()}))
        lane = lanes[c]
        nodes = own | {f"column_{d}": f"line_{d}{c}" for d in "ab"} | {"group": f"turn_column{c}"}
        nodes |= {f"{name}_{d}": f"{name}{d}{lane}" for name in ("lane", "sense") for d in "ab"}
        deck.append(f"Xcolumn{c} {' '.join(nodes.get(pin, pin) for pin in map(block_line, PINS))} column")
        for tap, pair in taps.items():
            for diode, value in zip("ab", pair, strict=True):
                ampere = value / DIODE * spec.full_well * ELEMENTARY_CHARGE / integration
                deck.append(f"Gphoto{diode}{c}_{tap} well_{diode}{c} 0 light{tap} 0 {ampere:.9g}")
    return deck


def levels(mode: str, spec: ColumnSpec) -> dict[str, float]:
    """V of `reference` and `dark`, at which the lanes' lines begin: of code 0 in edge mode, else of code -128.

    In raw mode an LSB at a lane is two of a column.
    """
    below = {"edge": 0.0, "raw": CODES * spec.lsb}.get(mode, CODES / 2 * spec.lsb)
    return {"reference": spec.dark - below, "dark": spec.dark - (below if mode == "raw" else 0.0)}


def begun(volts: Mapping[str, float]) -> str:
    """Return the line of a deck by which nodes begin at ``volts``, one at least."""
    return ".ic " + " ".join(f"v({name})={volt:.6g}" for name, volt in volts.items())


def amplifier_bias(lane: int, rest: Mapping[str, float]) -> str:
    """Return the line by which the bias of a lane's amplifier begins at the levels of the columns' bias."""
    return begun({f"xbias{lane}.{name}": rest[f"xcolumn_source.{name}"] for name in SOURCE})


def _of_column(net: str, c: int) -> str:
    return f"{net}{c}" if net.startswith("line_") else f"xcolumn{c}.{net}"


def nets(circuit: Circuit, inside: str = "") -> Iterator[str]:
    """Yield the nodes of a circuit and of the circuits in it, by SPICE's names: xback_a.xtap0.inner."""
    ends = [*(t.nodes for t in circuit.transistors), *((c.a, c.b) for c in circuit.capacitors)]
    ends += [one.nodes for one in circuit.instances]
    yield from (inside + net for net in sorted({net for nodes in ends for net in nodes} - set(circuit.ports)))
    for one in circuit.instances:
        yield from nets(one.circuit, f"{inside}x{one.name}.")


def drive(source: Drive, columns: Sequence[int], lanes: Sequence[int], first: int, cols: int, high: float) -> None:
    """Makes every control. first: the bit of the row's reset; what follows it is as in front_end.sv."""
    more = first + 3 + TAPS
    apart = more + 2 + 4 * TAPS + cols + 1
    source("w0_a", high, apart)
    source("f0_a", high, apart + 1, rise=GAP, fall=3 * AFTER)
    source("fn0_a", 0.0, apart + 2, low=high, rise=GAP, fall=3 * AFTER)
    source("reset_row", ROW, first)
    source("read_row", ROW, first + 1, rise=GAP, fall=10 * GAP)
    source("row_ref", high, first + 2)
    source("row_refn", 0.0, first + 2, low=high)
    source("sig", high, first + 1, rise=GAP, fall=GAP)
    source("sign", 0.0, first + 1, low=high, rise=GAP, fall=GAP)
    source("reads", high, more, fall=2 * GAP)
    source("readsn", 0.0, more, low=high, fall=2 * GAP)
    source("idle", 0.0, more + 1, low=high, fall=3 * AFTER)
    for t in range(TAPS):
        source(f"w{t}", high, more + 2 + t)
        source(f"f{t}", high, more + 2 + TAPS + t, rise=GAP, fall=3 * AFTER)
        source(f"fn{t}", 0.0, more + 2 + 3 * TAPS + t, low=high, rise=GAP, fall=3 * AFTER)
        source(f"unasked{t}", 0.0, more + 2 + 2 * TAPS + t, low=high)
        source(f"light{t}", 1.0, -1)
    for c in columns:
        source(f"turn_column{c}", high, more + 2 + 4 * TAPS + c, rise=COLUMNS, fall=2 * AFTER)
    for lane in lanes:
        source(f"turn{lane}", high, lane, rise=COLUMNS / 2, fall=2 * AFTER)
        source(f"turnn{lane}", 0.0, lane, low=high, rise=COLUMNS / 2, fall=2 * AFTER)


@cache
def trimmed(spec: ColumnSpec, edge: bool, cycle: float, high: float, drawn: bool = False) -> Trim:
    """Bias alone, from off; then, STEPS times, a pixel without light. drawn: of the column as drawn. Raises ToolError.

    Each begins as the one before ended, and so does a row. The bias's lines are given to the first, too: where ngspice
    finds no operating point it takes the end of a transient, 10 us long, and they need milliseconds.
    """
    sizes, pixels = size(spec, analog), PixelSizes()
    reset, read, ends = 2, 6, 6 + spec.settle + spec.read
    turn = ends + 2
    halves = range(read, read + spec.settle), range(read + spec.settle, ends)
    more = 3 + TAPS
    on = {0: range(1, reset + 1), 1: halves[1], 2: halves[0], more: range(read, ends)}
    on |= {more + 1: [*range(read, ends), turn], more + 2: range(read, ends), more + 2 + TAPS: [*halves[1], turn]}
    on |= {more + 2 + 2 * TAPS: range(turn + 2), more + 2 + 3 * TAPS: on[more + 1], more + 2 + 4 * TAPS: [turn]}
    apart = more + 2 + 4 * TAPS + 2  # of a single column
    on |= {apart: on[more + 2], apart + 1: on[more + 2 + TAPS], apart + 2: on[more + 1]}
    lane_bit = 100  # the lane's own, none of the row's
    on[lane_bit] = [turn]
    waves: dict[str, list[tuple[float, float]]] = {}

    def source(name: str, up: float, bit: int, rise: float = 0.0, fall: float = 0.0, low: float = 0.0) -> str:
        points, now = [(0.0, low)], low
        for k in range(turn + 2):
            level = up if k in on.get(bit, ()) else low
            if level != now:
                at = k * cycle + (rise if level == up else fall)
                points += [(at, now), (at + 1e-10, level)]
                now = level
        waves[name] = points
        return name

    drive(source, (0,), (lane_bit,), 0, 1, high)
    layouts = extracted.circuits() if drawn else {}
    parts = [layouts.get(one.name, one) for one in circuits(spec, sizes)]
    inner = {one.name: one for part in parts for one in part.circuits().values()}
    deck = [*analog.cards("tt", set().union(*(one.sizes() for one in parts))), ".param cscale=1 rscale=1"]
    deck += [line for one in inner.values() for line in one.own_lines(analog)]
    deck += [CURRENT, *NO_TRANSIENT]
    rails, outs = {"vdd": high}, [f"col{d}{lane_bit}" for d in "ab"]
    with Simulator([*deck, *BIAS], (), RESTING, rails, CELSIUS, EXACT) as spice:
        wave = spice.transient({}, {}, SETTLED, SETTLED / 20)
    rest = rails | {name: wave.at(name, SETTLED) for name in RESTING}
    begin = {f"line_{d}": LINE for d in "ab"} | {f"cin_{d}": CIN for d in "ab"} | {f"out_{d}": high for d in "ab"}
    trim = Trim((spec.dark, spec.dark), rest, begin | {"quarter": high, "half": high * edge}, spice.repeated)
    inside = ("line_a", "line_b", *nets(column(sizes)))
    names = {net: extracted.flat(_of_column(net, 0)) if drawn else _of_column(net, 0) for net in inside}
    end, over = float(np.nextafter((turn + 1) * cycle, 0)), (turn + 2) * cycle
    for _ in range(STEPS):
        mode = "edge" if edge else "image"
        own = lines({0: {0: (0.0, 0.0)}}, {0: lane_bit}, mode, 1.0, spec, sizes, pixels, trim)
        own = extracted.as_drawn(own, layouts)
        with Simulator([*deck, *own], tuple(waves), (*outs, *names.values()), rails, CELSIUS, EXACT) as spice:
            wave = spice.transient(waves, dict.fromkeys(outs, spec.input), over, cycle / 5)
        start = nearer(trim.start, (wave.at(outs[0], end), wave.at(outs[1], end)), spec, sizes)
        left = {net: wave.at(node, over) for net, node in names.items()}
        trim = Trim(start, rest, left, trim.repeated + spice.repeated)
    return trim
