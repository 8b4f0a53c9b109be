"""A column with its pixel's wells, the block's bias and a lane's lines, at one corner; with mismatch; its noise.

    cycle    | 0     | 1 ...      16 | 17 ...     32 | 33    | 34    | 35
    read     |_______|‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾|‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾|_______|_______|___
    ref_ctl  |_______|‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾|_______________|_______|_______|___
    row      |_______|_______________|‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾|_______|_______|___      the wells are at their lines
    turn     |_______|_______________|_______________|_______|‾‾‾‾‾‾‾|___

The wells are as much larger than nominal as the capacitors are at a corner, so that a slope is over theirs.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from types import MappingProxyType, ModuleType
from typing import NamedTuple

import numpy as np

from talbot.cells.corner import Corner
from talbot.cells.spice.engine import Points, Simulator
from talbot.cells.spice.settings import Settings
from talbot.cells.spice.wave import Wave
from talbot.models.parameters.electrical import BOLTZMANN
from talbot.pixels.circuits import column as columns
from talbot.pixels.circuits.amplifier import BIAS
from talbot.pixels.circuits.column import BIASES, CONTROLS, SUPPLIES, column
from talbot.pixels.circuits.column_block import (
    CASCODES,
    OUTSIDE,
    cascode_lines,
    clear_pulse,
    column_bias,
    lane_end,
    lane_line,
)
from talbot.pixels.circuits.column_sizes import EFFICIENCY, FRONT, LANE, ColumnSizes, ColumnSpec, source_of
from talbot.pixels.circuits.netlist import Capacitor, Circuit, Instance, Transistor
from talbot.pixels.circuits.row_driver import THICK
from talbot.pixels.circuits.support import bias
from talbot.pixels.datasheet.deck import EDGE, SETTINGS, Setup, deck, settling, simulator
from talbot.pixels.datasheet.noise import GAMMA

ROW = 3.3  # V of the row's lines: wells at the charge amplifiers' level ask for less than the drawn pixel's 5 V
# By the trapezoidal rule the same line was 0.15 LSB off from run to run, a third of a limit, and with a trtol of 1 or 3
# half of the runs failed; by Gear's method 0.002
EXACT = replace(SETTINGS, reltol=1e-4, method="gear")
# With the usual abstol of 1 fA some runs find no operating point; what a column may lose is 5 pA an LSB
CURRENT = ".option abstol=1e-13"
SLOPE = 8e-9  # s in which a row's line rises, as drawn; at ss_n40C_1v62 no run ended where it was an edge
GAP = 1e-9  # s between controls that must not be high together: gate delays of the block's bank
REST = 1  # cycles before the read, and between it and the turn
WELLS = 0.0, 0.2, 0.4, 0.6, 0.8  # of a full well: a straight line through these
BOTH = 0.8, 0.4  # of a full well, of the diodes whose mean is measured
SETTLED = 20e-6  # s until the bias alone is at rest
TRIMS = 2  # steps to the trimmed level
FULL = 0.98  # of a full well: what is lost there
# s in which the wells get their charge, right before they are at their lines: a switch that is off leaks, which is the
# pixel's (at ff_125C_1v98 three LSB a us of a well at 0.04 V, by its line)
LIGHT = 0.1e-6
QUIET = {
    f"{name}{t}": high
    for name, high in (("w", False), ("f", False), ("fn", True), ("unasked", True))
    for t in range(1, columns.TAPS)
}
DRIVEN = (
    "group",
    "k",
    *(name for name in CONTROLS if name not in (*CASCODES, "clear")),
    "readsn",
    "refn",
    "w0",
    "f0",
    "fn0",
    "unasked0",
    "turn",
    "turnn",
    "turnb",
    "turnbn",
    "row",
    "fill",
    "x_a",
    "x_b",
)
NAMES = {"lane_a": "near_a", "lane_b": "near_b"}  # of a column's pins in the bench
STRAY = 40e-15  # F at the holder's output
PIXEL = "n_thick"  # role of its pixel's switches, which are no part of a column


class Additions(NamedTuple):
    """Additions of a deck to the bench: lines, inputs, rails (V)."""

    lines: tuple[str, ...] = ()
    inputs: tuple[str, ...] = ()
    rails: Mapping[str, float] = MappingProxyType({})


NOTHING = Additions()


@dataclass(frozen=True)
class ColumnResult:
    """At one corner; LSB of the lane's converter in edge mode where nothing else is said.

    start: V of both diodes at which a column without light leaves its lanes at their references. slope: V of the
    lane's line over the ideal one; mean: of both diodes' mean, in the modes with codes 0..255. inl: peak off a straight
    line through WELLS. full: lost at FULL of a well. other: of a diode by the other's light, the larger. settling: s of
    the turn until half an LSB, the slowest. droop: until the last column's turn. energy: J a pixel. idle: A of a column
    in which nothing happens.
    """

    start: tuple[float, float]
    slope: float
    inl: float
    full: float
    mean: float
    other: float
    settling: float
    droop: float
    energy: float
    idle: float
    runs: int
    repeated: int


def measure(
    setup: Setup, spec: ColumnSpec, sizes: ColumnSizes, corner: Corner, circuit: Circuit | None = None
) -> ColumnResult:
    """Measure a column. circuit: instead of the bench of ``sizes``."""
    start, runs, repeated = trimmed(setup, spec, sizes, corner, circuit), TRIMS, 0
    end, lsb = turn_of(spec) + spec.cycle, spec.lsb
    with opened(setup, spec, sizes, corner, start, circuit=circuit) as spice:
        waves = [sample(spice, spec, corner, part * spec.fall, 0.0) for part in (*WELLS, FULL)]
        second = sample(spice, spec, corner, 0.0, WELLS[-1] * spec.fall)
        late = sample(spice, spec, corner, WELLS[-1] * spec.fall, 0.0, wait=spec.wait)
        runs, repeated = runs + spice.runs, repeated + spice.repeated
    out = np.array([wave.at("far_a", end) for wave in waves])
    wanted = -spec.swing * np.array(WELLS)
    slope, offset = np.polyfit(wanted, out[:-1], 1)
    with opened(setup, spec, sizes, corner, start, True, circuit=circuit) as spice:
        mean, light = mean_of(spice, spec, corner)
        runs, repeated = runs + spice.runs, repeated + spice.repeated
    moved = [late.at(f"far_{d}", end + spec.wait) - waves[len(WELLS) - 1].at(f"far_{d}", end) for d in "ab"]
    return ColumnResult(
        start=start,
        slope=float(slope),
        inl=float(np.abs(out[:-1] - offset - slope * wanted).max() / lsb),
        full=float((out[-1] - offset + slope * spec.swing * FULL) / lsb),
        mean=mean,
        other=max(
            abs(wave.at(f"far_{d}", end) - waves[0].at(f"far_{d}", end)) / lsb
            for d, wave in (("b", waves[len(WELLS) - 1]), ("a", second))
        ),
        settling=max(settling(wave, "far_a", turn_of(spec), end, 0.5 * spec.lsb) for wave in (*waves, light)),
        droop=max(abs(one) for one in moved) / lsb,
        energy=_energy(waves[2], spec, corner),
        idle=waves[0].charge("vdd", 0.2 * spec.cycle, 0.9 * spec.cycle) / (0.7 * spec.cycle),
        runs=runs,
        repeated=repeated,
    )


def mean_of(spice: Simulator, spec: ColumnSpec, corner: Corner) -> tuple[float, Wave]:
    """`ColumnResult.mean` of a bench that is `opened` for an image, and the transient with light."""
    dark, light = (sample(spice, spec, corner, a * spec.fall, b * spec.fall, True) for a, b in ((0.0, 0.0), BOTH))
    end = turn_of(spec) + spec.cycle
    return (dark.at("far_a", end) - light.at("far_a", end)) / (spec.swing * sum(BOTH) / 4), light


def trimmed(
    setup: Setup, spec: ColumnSpec, sizes: ColumnSizes, corner: Corner, circuit: Circuit | None = None
) -> tuple[float, float]:
    """Return `start_a` and `start`, V, at which a column without light is at the lanes' references."""
    end, start = turn_of(spec) + spec.cycle, (spec.dark, spec.dark)
    for _ in range(TRIMS):
        with opened(setup, spec, sizes, corner, start, circuit=circuit) as spice:
            wave = sample(spice, spec, corner, 0.0, 0.0)
        start = nearer(start, (wave.at("far_a", end), wave.at("far_b", end)), spec, sizes)
    return start


def nearer(
    start: tuple[float, float], lanes: tuple[float, float], spec: ColumnSpec, sizes: ColumnSizes
) -> tuple[float, float]:
    """Return `start_a` and `start`, V, that bring ``lanes``, V of both without light, to their references."""
    a, b = (volt + (spec.dark - lane) / sizes.follows for volt, lane in zip(start, lanes, strict=True))
    return a, b


def offset(
    setup: Setup,
    spec: ColumnSpec,
    sizes: ColumnSizes,
    corner: Corner,
    start: tuple[float, float],
    seed: int,
    pixel: bool = False,
) -> float:
    """Return the offset between both diodes' lines without light, LSB, of a column with the models' mismatch.

    pixel: of its pixel's switches alone, which all others are without. With looser tolerances than other figures have:
    0.17 LSB off at most, in a third of the time.
    """
    end = turn_of(spec) + spec.cycle
    alike = {role for role, *_ in bench(sizes, spec).sizes() if (role == PIXEL) != pixel}
    with opened(setup, spec, sizes, corner, start, seed=seed, alike=alike, settings=SETTINGS) as spice:
        wave = sample(spice, spec, corner, 0.0, 0.0)
    return (wave.at("far_a", end) - wave.at("far_b", end)) / spec.lsb


def noise(spec: ColumnSpec, sizes: ColumnSizes, process: ModuleType, celsius: float) -> float:
    """Electrons, rms, of a diode, in closed form: k T gamma (1 + source's share) / (beta C) of each stage.

    The reference half has as much of both stages as the signal half, the turn adds its own once. Reset noise of the
    charge amplifier is taken off. ngspice's `.noise` has far less than this of transistors in weak inversion.
    """
    stages = (
        (
            sizes.gain,
            2,
            "front",
            FRONT,
            sizes.front,
            sizes.feedback,
            spec.line + spec.well,
            1.25 * sizes.gain * sizes.hold,
        ),
        (1.0, 2, "back", LANE, sizes.back, sizes.hold, sizes.gain * sizes.hold, STRAY),
        (1.0, 1, "lane", LANE, sizes.lane, sizes.hold, 0.0, 2 * spec.wire + spec.input),
    )
    total, gates = 0.0, {name: process.operating(*kind, EFFICIENCY[name]).gate for _, _, name, kind, *_ in stages}
    driver = sizes.lane.input * gates["lane"]
    for gain, times, name, _, stage, feedback, inputs, load in stages:
        beta = feedback / (feedback + inputs + (stage.input * gates[name] if name == "front" else driver))
        white = BOLTZMANN * (celsius + 273.15) * GAMMA * (1 + EFFICIENCY[source_of(name)] / EFFICIENCY[name])
        total += times * gain**2 * white / (beta * (load + feedback * (1 - beta)))
    return total**0.5 / spec.swing * spec.full_well


def bench(sizes: ColumnSizes, spec: ColumnSpec) -> Circuit:
    """A column with bias, its part of what is outside of the chip at that, lines and wells; `own` are its pins."""
    quiet: dict[str, str] = NAMES | {name: "vdd" if high else "vss" for name, high in QUIET.items()}
    parts = [
        Instance("column", column(sizes), tuple(quiet.get(name) or name for name in map(columns.line, columns.PINS))),
        Instance("bias", bias(), ("ibias", "vdd_own", "vss")),
        Instance("lines", column_bias(sizes), ("ibias", *BIASES, "level", "vdd_bias", "vss")),
        Instance("cascodes", cascode_lines(), cascode_lines().ports),
        Instance("clear", clear_pulse(sizes), ("ref", "refn", "clear", "vbp", "vdd_own", "vss")),
    ]
    devices = list[Transistor]()
    capacitors = [Capacitor(f"outside_{name}", name, f"rest_{name}", OUTSIDE / spec.array) for name in BIASES]
    for d, reference in (("a", "reference"), ("b", "dark")):
        turn = ("turn", "turnn") if d == "a" else ("turnb", "turnbn")
        end = (f"far_{d}", reference, *turn, "vbl", "vcp", *SUPPLIES)
        parts.append(Instance(f"end_{d}", lane_end(sizes), end))
        parts.append(Instance(f"line_{d}", lane_line(sizes, spec), (f"near_{d}", f"sense_{d}", f"far_{d}", "vss")))
        devices.append(Transistor(f"read_{d}", f"well_{d}", "row", f"column_{d}", "vss", PIXEL, 0.42, THICK))
        capacitors += [
            Capacitor(f"line_{d}", f"column_{d}", "vss", spec.line),
            Capacitor(f"well_{d}", f"well_{d}", "vss", spec.well, 1),
            Capacitor(f"input_{d}", f"far_{d}", "vss", spec.input),
        ]
    own = (
        *(name for name in DRIVEN if name not in ("fill", "x_a", "x_b")),
        "well_a",
        "well_b",
        "level",
        "start",
        "start_a",
    )
    own += ("dark", "reference", "far_a", "far_b", "vdd_bias", "vdd_own")
    own += (*BIASES, *(f"rest_{name}" for name in BIASES))
    own += SUPPLIES
    return Circuit("bench", own, tuple(devices), tuple(capacitors), instances=tuple(parts))


@cache
def at_rest(setup: Setup, sizes: ColumnSizes, corner: Corner) -> dict[str, float]:
    """Return the voltages of the bias lines, V."""
    parts = (
        Instance("bias", bias(), ("ibias", "vdd", "vss")),
        Instance("lines", column_bias(sizes), ("ibias", *BIASES, "level", "vdd", "vss")),
    )
    lines = deck(Circuit("rest", (*BIASES, "level", "vdd", "vss"), instances=parts), setup, corner)
    with simulator(lines, (), BIASES, corner, settings=EXACT) as spice:
        wave = spice.transient({}, {}, SETTLED, SETTLED / 20)
    return {name: wave.at(name, SETTLED) for name in BIASES}


def opened(
    setup: Setup,
    spec: ColumnSpec,
    sizes: ColumnSizes,
    corner: Corner,
    start: tuple[float, float],
    image: bool = False,
    seed: int | None = None,
    alike: Collection[str] = (),
    more: Sequence[str] = (),
    circuit: Circuit | None = None,
    settings: Settings = EXACT,
    additions: Additions = NOTHING,
) -> Simulator:
    """An ngspice process of the bench. image: the first lane's reference is the middle. seed: of mismatch, but of the
    roles in ``alike``. more: nodes that are kept.

    The bias's lines are held until a row is read, or what is outside of the chip at them would take milliseconds: where
    ngspice finds an operating point by a transient, it ends long before.
    The coupling capacitors begin empty, as leakage leaves them after a pause: the second stage has farthest to go.
    """
    lines = deck(circuit or bench(sizes, spec), setup, corner, seed=seed, alike=alike)
    lines.append(f".model filling sw vt={corner.supply / 2:g} vh=0 ron=1000 roff=1e15")
    ampere = spec.well * setup.scale(corner) / LIGHT
    for d in "ab":
        lines += [f"Sreset_{d} well_{d} level fill 0 filling", f"Glight_{d} well_{d} 0 x_{d} 0 {ampere:.9g}"]
    lines += [f"Shold_{name} {name} rest_{name} fill 0 filling" for name in BIASES]
    lines += [f"Sempty_{d} xcell.xcolumn.cin_{d} 0 fill 0 filling" for d in "ab"]
    rails = {"start_a": start[0], "start": start[1], "dark": spec.dark, "reference": spec.dark - image * spec.swing / 4}
    rails |= {"vdd_bias": corner.supply, "vdd_own": corner.supply}
    rails |= {f"rest_{name}": volt for name, volt in at_rest(setup, sizes, corner).items()}
    lines, rails = [*lines, *additions.lines, CURRENT], rails | dict(additions.rails)
    return simulator(lines, (*DRIVEN, *additions.inputs), ("far_a", "far_b", "level", *more), corner, rails, settings)


def sample(
    spice: Simulator,
    spec: ColumnSpec,
    corner: Corner,
    a: float,
    b: float,
    image: bool = False,
    wait: float = 0.0,
    cycles: int = 1,
    more: Mapping[str, Points] | None = None,
    loads: Mapping[str, float] | None = None,
) -> Wave:
    """A transient: a row is read whose wells have the charge of a and b V, and ``wait`` s later than else a turn.

    cycles: of the turn. more, loads: of the inputs and nodes of `Additions`.
    """
    high, t = corner.supply, spec.cycle
    begin, middle = REST * t, (REST + spec.settle) * t
    end, turn = middle + spec.read * t, turn_of(spec) + wait
    over = turn + cycles * t

    def pulse(start: float, stop: float, low: float = 0.0, edge: float = EDGE) -> Points:
        return [(0.0, low), (start, low), (start + edge, high - low), (stop, high - low), (stop + edge, low)]

    def both(start: float, stop: float, again: float, off: float, low: float = 0.0) -> Points:
        return [*pulse(start, stop, low), *pulse(again, off, low)[1:]]

    stimulus: dict[str, Points] = {
        "reads": pulse(begin, end + 2 * GAP),
        "readsn": pulse(begin, end + 2 * GAP, high),
        "ref": pulse(begin, middle),
        "refn": pulse(begin, middle, high),
        "w0": [(0.0, high), (end, high), (end + EDGE, 0.0)],  # from before on: its capacitor begins at level
        "sig": pulse(middle + GAP, end + GAP),
        "sign": pulse(middle + GAP, end + GAP, high),
        "f0": both(middle + GAP, end + GAP, turn, over + 2 * GAP),
        "fn0": both(begin, end + GAP, turn, over + 2 * GAP, high),
        "idle": both(begin, end + 2 * GAP, turn, over + 2 * GAP, high),
        "row": [(s, v / high * ROW) for s, v in pulse(middle + GAP, end + 10 * GAP, edge=SLOPE)],
        "edge": [(0.0, 0.0 if image else high)],
        "edgen": [(0.0, high if image else 0.0)],
        "turn": pulse(turn, over + GAP),
        "turnn": pulse(turn, over + GAP, high),
        "turnb": [(0.0, 0.0)] if image else pulse(turn, over + GAP),
        "turnbn": [(0.0, high)] if image else pulse(turn, over + GAP, high),
        "group": pulse(turn + GAP, over + GAP),
        "k": [(0.0, high)],
        "unasked0": [(0.0, 0.0)],
        "fill": [(0.0, high), (begin, high), (begin + EDGE, 0.0)],
    }
    for name, volts in (("x_a", a), ("x_b", b)):
        stimulus[name] = [(s, v / high * volts) for s, v in pulse(middle - LIGHT, middle)]
    return spice.transient(stimulus | dict(more or {}), loads or {}, over + t, t / 5)


def turn_of(spec: ColumnSpec) -> float:
    """Return the time at which the turn begins, s."""
    return (2 * REST + spec.settle + spec.read) * spec.cycle


def _energy(wave: Wave, spec: ColumnSpec, corner: Corner) -> float:
    """Return the energy of a pixel, J: read, turn, and its share of the block's bias."""
    read = wave.charge("vdd", REST * spec.cycle, turn_of(spec) - 0.5 * spec.cycle)
    turn = wave.charge("vdd", turn_of(spec) - 0.5 * spec.cycle, turn_of(spec) + 1.5 * spec.cycle)
    steady = wave.charge("vdd_bias", 0.1 * spec.cycle, 0.9 * spec.cycle) / (0.8 * spec.cycle) + BIAS
    return (read + turn + steady * spec.pixel) * corner.supply
