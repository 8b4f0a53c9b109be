"""The column amplifiers of one row in transistors, for the deck of a co-simulation: pixels/circuits/column.py.

Their lines are driven as the block's bank drives them, its gates' delays as delays of the drive; the pulse that ends by
itself is the bank's own circuit. Row lines have 3.3 V, wells are reset to the level of the block's bias.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache

import numpy as np

from talbot.cells.spice.engine import Simulator
from talbot.flow.analog.amplifier import COLUMNS, EXACT
from talbot.flow.analog.column import GAP, ROW, TRIMS, nearer
from talbot.models.parameters import DIODE, ELEMENTARY_CHARGE, AmpTiming
from talbot.pixels.circuits.column import BIASES, PINS, TAPS, column, line
from talbot.pixels.circuits.column_block import OUTSIDE, cascode_lines, clear_pulse, column_bias, lane_end, lane_line
from talbot.pixels.circuits.column_sizes import ColumnSizes, ColumnSpec, size
from talbot.pixels.circuits.netlist import Circuit
from talbot.pixels.circuits.row_driver import THICK
from talbot.pixels.circuits.specification import CODES
from talbot.pixels.circuits.support import bias
from talbot.platforms.sky130 import analog

from . import extracted
from .amplified import AFTER, Drive
from .pixels import PixelSizes, pixel, row_line

TIMING = AmpTiming()  # of a row with these columns: the holder has 16 cycles in each half
CELSIUS = 25.0
LINE = 0.5  # V of a column's line, since the row before was read
CIN = {True: (1.58, 1.58), False: (1.04, 1.58)}  # of both coupling capacitors, by `edge`: the row before was 40 % full
SOURCE = "vbn", "vbp", "source", "start", "part_1", "part_2", "part_3"  # nodes of a bias
# Of the trim: with a reltol of 1e-4 a line was 0.5 mV off, or not, as its level changed by 0.1 mV; 1e-5 and 1e-6 agree.
# The drawn column's trim ends at a rail with 1e-5, which is not understood: it has 1e-4
FINE = replace(EXACT, reltol=1e-5)
RESTING = (*BIASES, "level", "ibias_columns", *(f"xcolumn_source.{name}" for name in SOURCE))


def circuits(spec: ColumnSpec, sizes: ColumnSizes) -> tuple[Circuit, ...]:
    """All that the lines of a deck call."""
    parts = column(sizes), column_bias(sizes), clear_pulse(sizes), lane_end(sizes), lane_line(sizes, spec), bias()
    return (*parts, cascode_lines(), pixel(spec.well, "n_thick", THICK))


def lines(
    diodes: Mapping[int, Mapping[int, tuple[float, float]]],
    lanes: Mapping[int, int],
    edge: bool,
    high: float,
    integration: float,
    spec: ColumnSpec,
    sizes: ColumnSizes,
    pixels: PixelSizes,
    start: tuple[float, float],
    rest: Mapping[str, float],
    cols: int = 1,
    swapped: frozenset[int] = frozenset(),
    cut: int | None = None,
) -> list[str]:
    """Lines of the deck; see `drive` for their controls. lanes: of each column; the lanes' lines end at cola0, colb0.

    diodes: (a, b) in LSB of each column and tap. edge: lanes get both diodes, else the mean. high: V of the supply.
    start: V of start_a and start, trimmed. rest: V of RESTING, with which it begins: an operating point of so many
    nodes that float takes minutes. cols: that the row's lines pass. swapped: columns whose diodes are on each other's
    line. cut: column from which on the row's read line is open.
    """
    own = {"edge": "vdd" if edge else "0", "edgen": "0" if edge else "vdd", "k": "vdd", "vss": "0", "ref": "row_ref"}
    resting = dict(rest)
    for lane in set(lanes.values()) if rest else ():  # the bias of its amplifier is at the same levels
        resting |= {f"xbias{lane}.{name}": rest[f"xcolumn_source.{name}"] for name in SOURCE}
    deck = [
        f"Vdark dark 0 {spec.dark:g}",
        f"Vreference reference 0 {spec.dark - (not edge) * CODES / 2 * spec.lsb:.9g}",
        *(f"V{name} {name} 0 {volts:.9g}" for name, volts in zip(("start_a", "start"), start, strict=True)),
        *([".ic " + " ".join(f"v({name})={volts:.6g}" for name, volts in resting.items())] if rest else []),
        *(f"Coutside_{name} {name} 0 {OUTSIDE:g}" for name in (*BIASES, "level")),
        "Xcolumn_source ibias_columns vdd 0 bias",
        f"Xcolumn_bias ibias_columns {' '.join(BIASES)} level vdd 0 column_bias",
        f"Xcascodes vcn reads readsn {own['edge']} {own['edgen']} cn vcnb 0 cascode_lines",
        "Xclear row_ref row_refn clear vbp vdd 0 clear_pulse",
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
        floats = {f"line_{d}{c}": LINE for d in "ab"} | {f"xcolumn{c}.out_{d}": high for d in "ab"}
        floats |= {f"xcolumn{c}.cin_{d}": volts for d, volts in zip("ab", CIN[edge], strict=True)}
        floats |= {f"xcolumn{c}.quarter": high, f"xcolumn{c}.half": high * edge}
        deck.append(".ic " + " ".join(f"v({name})={volts:g}" for name, volts in floats.items()))
        lane = lanes[c]
        nodes = own | {f"column_{d}": f"line_{d}{c}" for d in "ab"} | {"group": f"turn_column{c}"}
        nodes |= {f"{name}_{d}": f"{name}{d}{lane}" for name in ("lane", "sense") for d in "ab"}
        deck.append(f"Xcolumn{c} {' '.join(nodes.get(pin, pin) for pin in map(line, PINS))} column")
        for tap, pair in taps.items():
            for diode, value in zip("ab", pair, strict=True):
                ampere = value / DIODE * spec.full_well * ELEMENTARY_CHARGE / integration
                deck.append(f"Gphoto{diode}{c}_{tap} well_{diode}{c} 0 light{tap} 0 {ampere:.9g}")
    return deck


def drive(source: Drive, columns: Sequence[int], lanes: Sequence[int], first: int, high: float) -> None:
    """Makes every control. first: the bit of the row's reset; what follows it is as in front_end.sv."""
    more = first + 3 + TAPS
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
def trimmed(
    spec: ColumnSpec, edge: bool, cycle: float, high: float, drawn: bool = False
) -> tuple[tuple[float, float], dict[str, float]]:
    """V of start_a and start at which a pixel without light leaves its lanes at dark, of the bias's lines at rest.

    Simulated TRIMS times. drawn: of the column as drawn. Raises ToolError.
    """
    sizes, pixels = size(spec, analog), PixelSizes()
    reset, read, ends = 2, 6, 6 + spec.settle + spec.read
    turn = ends + 2
    halves = range(read, read + spec.settle), range(read + spec.settle, ends)
    more = 3 + TAPS
    on = {0: range(1, reset + 1), 1: halves[1], 2: halves[0], more: range(read, ends)}
    on |= {more + 1: [*range(read, ends), turn], more + 2: range(read, ends), more + 2 + TAPS: [*halves[1], turn]}
    on |= {more + 2 + 2 * TAPS: range(turn + 2), more + 2 + 3 * TAPS: on[more + 1], more + 2 + 4 * TAPS: [turn]}
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

    drive(source, (0,), (lane_bit,), 0, high)
    layouts = extracted.circuits() if drawn else {}
    parts = [layouts.get(one.name, one) for one in circuits(spec, sizes)]
    inner = {one.name: one for part in parts for one in part.circuits().values()}
    deck = [*analog.cards("tt", set().union(*(one.sizes() for one in parts))), ".param cscale=1 rscale=1"]
    deck += [line for one in inner.values() for line in one.own_lines(analog)]
    outs, found = [f"col{d}{lane_bit}" for d in "ab"], dict[str, float]()
    start = spec.dark, spec.dark
    for _ in range(TRIMS):
        own = lines({0: {0: (0.0, 0.0)}}, {0: lane_bit}, edge, high, 1.0, spec, sizes, pixels, start, {})
        own += extracted.rest_of_nets(own, layouts)
        if found:  # or the search for an operating point may end elsewhere
            own.append(".nodeset " + " ".join(f"v({name})={volts:.6g}" for name, volts in found.items()))
        with Simulator(
            [*deck, *own], tuple(waves), (*outs, *RESTING), {"vdd": high}, CELSIUS, EXACT if drawn else FINE
        ) as spice:
            wave = spice.transient(waves, dict.fromkeys(outs, spec.input), (turn + 1) * cycle, cycle / 5)
        end = float(np.nextafter((turn + 1) * cycle, 0))
        start = nearer(start, (wave.at(outs[0], end), wave.at(outs[1], end)), spec, sizes)
        found = {name: wave.at(name, 0.0) for name in RESTING}
    return start, {"vdd": high} | found
