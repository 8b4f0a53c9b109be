"""Setup, hold, recovery, removal and the shortest pulses, by bisection.

A constraint is kept while the output ends where it should and, if it moves, takes at most Conditions.degrade longer
than without any pressure. Near the edge a flip-flop can be metastable for any time: a run that has not settled by its
end, or not finished by its timeout, does not keep the constraint.

The output carries the load at two thirds of the way to its limit: with it SkyWater's setup and hold times of both
edges are met best; with the least load those of a rising output are 15 to 30 ps longer, for its delay may grow by less.
What is left would let a path pass that fails with SkyWater's tables: MARGINS are added, one for all cells and corners.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from talbot.cells.characterize.bench import Bench
from talbot.cells.characterize.measured import Constraint
from talbot.cells.characterize.scenario import Scenario, Scenarios
from talbot.cells.characterize.tries import Tries
from talbot.cells.netlist.states import Output, State
from talbot.cells.spice.engine import SimulationError

Floats = npt.NDArray[np.float64]
RESOLUTION = 2e-12  # s, of a bisection
RELTOL = 1e-3  # moves a setup time by less than 1 ps, and takes half the time of 1e-4
NEAR = 16e-12  # s, first step away from a guess
PATIENCE = 5.0  # s of run time for one run of a search
# Shares of the clock-to-output delay, of the data's slew and of the clock's, added to what is measured: from the errors
# in docs/results/cells.md
MARGINS = {"setup": (0.04, 0.01, 0.0), "hold": (0.01, 0.0, 0.01), "recovery": (0, 0, 0), "removal": (0.02, 0.01, 0.0)}
FAR = 1.0  # share of the settling time in which a constraint is searched, beyond the ramps


class Event(NamedTuple):
    """Input number ``pin`` goes to ``level``: when (s) its 50 % point is after the clock's, with which slew (s)."""

    pin: int
    when: float
    level: int
    slew: float


def constraints(bench: Bench, tried: Tries) -> list[Constraint]:
    """Every constraint of a cell with storage."""
    scenarios = Scenarios(bench.cell)
    storage, slews = scenarios.storage, bench.conditions.constraint_slews
    results: list[Constraint] = []
    edge = "rising" if bool(storage.active) != (storage.kind == "latch") else "falling"

    def searched(pin: str, kind: str, rise: Sequence[Scenario], fall: Sequence[Scenario]) -> None:
        constraint: Constraint = {"pin": pin, "related": storage.clock, "type": kind, "slews": slews}
        if rise:
            constraint["rise"] = tried(f"{pin} rise: {kind}", _longest, bench, rise, kind)
        if fall:
            constraint["fall"] = tried(f"{pin} fall: {kind}", _longest, bench, fall, kind)
        results.append(constraint)

    for pin in storage.data_pins:
        searched(pin, f"setup_{edge}", scenarios.setup(pin, 1), scenarios.setup(pin, 0))
        searched(pin, f"hold_{edge}", scenarios.hold(pin, 1), scenarios.hold(pin, 0))
    for pin, level in storage.asynchronous:
        for kind, early in (("recovery", True), ("removal", False)):
            release = scenarios.release(pin, early)
            searched(pin, f"{kind}_{edge}", [] if level else release, release if level else [])
    pulses = set(storage.asynchronous)
    pulses |= {(storage.clock, level) for level in ((0, 1) if storage.kind != "latch" else (storage.active,))}
    for pin in sorted({pin for pin, _ in pulses}):
        widths: Constraint = {"pin": pin, "related": pin, "type": "min_pulse_width", "slews": slews}
        for level, pulse in ((0, "fall"), (1, "rise")):
            if (pin, level) in pulses:
                widths[pulse] = tried(f"{pin}: pulse to {level}", _widths, bench, scenarios, pin, level)
        results.append(widths)
    return [f for f in results if f.get("rise") is not None or f.get("fall") is not None]


def _longest(bench: Bench, scenarios: Iterable[Scenario], kind: str) -> list[list[float]]:
    """The longest time that one of ``scenarios`` needs, for each pair of slews, with the margin of ``kind``."""
    longest = np.max([_times(bench, scenario) for scenario in scenarios], axis=0)
    return (longest + margin(kind, _clock_to_output(bench), bench.conditions.constraint_slews)).tolist()


def margin(kind: str, delay: float, slews: Sequence[float]) -> Floats:
    """The s that MARGINS add to a constraint ('setup_rising'): (slews of the clock, slews of the data).

    delay: s from the clock to the output.
    """
    of_delay, of_data, of_clock = MARGINS[kind.partition("_")[0]]
    data, clock = np.array(slews)[None, :], np.array(slews)[:, None]
    return of_delay * delay + of_data * data + of_clock * clock


def _clock_to_output(bench: Bench) -> float:
    """The longest delay in s from the clock to the first output, at the middle slew."""
    cell, c, output = bench.cell, bench.conditions, bench.machine.outputs[0]
    assert cell.storage
    arcs = [a for a in cell.arcs if (a.pin, a.output) == (cell.storage.clock, output)]
    load = bench.pressed.get(output, c.least_load)
    return max(bench.edge(arc.changes[0], output, c.middle_slew, load).delay for arc in arcs)


def _times(bench: Bench, scenario: Scenario) -> list[list[float]]:
    """Least times (s) between the two edges: (slews of the clock, slews of the data)."""
    slews = bench.conditions.constraint_slews
    table: list[list[float]] = []
    for i, clock in enumerate(slews):
        row: list[float] = []
        for j, data in enumerate(slews):
            guess = (table[i - 1][j] + (row[j - 1] - table[i - 1][j - 1] if j else 0)) if i else None
            row.append(_time(bench, scenario, clock, data, guess))
        table.append(row)
    return table


def _time(bench: Bench, scenario: Scenario, clock_slew: float, data_slew: float, guess: float | None) -> float:
    """Least time from data to clock (setup, recovery) or from clock to data (hold, removal), between 50 % points."""
    ramps = bench.conditions.ramp(clock_slew) + bench.conditions.ramp(data_slew)
    far = FAR * bench.settling + ramps
    sign = -1 if scenario.early else 1

    def run(offset: float) -> float | None:
        clock = Event(scenario.clock, 0.0, scenario.clock_to, clock_slew)
        events = [clock, Event(scenario.data, sign * offset, scenario.data_to, data_slew)]
        return outcome(bench, scenario.start, events, far, scenario.trigger, scenario.expected)

    return bisect(run, far, scenario.moves, bench.conditions.degrade, guess=guess)


def _widths(bench: Bench, scenarios: Scenarios, pin: str, level: int) -> list[float] | None:
    """Shortest pulse in s for every slew, between 50 % points: a ramp at least, and what the slower level needs."""
    cases = scenarios.pulses(pin, level)
    widths = [_shortest(bench, scenarios, pin, level, state, expected) for state, expected in cases]
    return np.max(widths, axis=0).tolist() if widths else None


def _shortest(bench: Bench, scenarios: Scenarios, pin: str, level: int, state: State, expected: Output) -> list[float]:
    number = bench.machine.inputs.index(pin)
    widths = []
    for slew in bench.conditions.constraint_slews:
        ramp = bench.conditions.ramp(slew)
        far = FAR * bench.settling + 2 * ramp
        moved_first = scenarios.after[state, number].outputs[0] == expected

        def run(width: float, slew: float = slew, far: float = far, first: bool = moved_first) -> float | None:
            events = [Event(number, 0.0, level, slew), Event(number, width, 1 - level, slew)]
            return outcome(bench, state, events, far, number, expected, edge=level if first else 1 - level)

        widths.append(bisect(run, far, True, bench.conditions.degrade, low=ramp))
    return widths


def outcome(
    bench: Bench, state: State, events: list[Event], far: float, trigger: int, expected: Output, edge: int | None = None
) -> float | None:
    """Delay of the first output in s, 0.0 when it stays as it should, None when it does not end as expected.

    edge: level that the trigger (an input number) goes to, that of its first event by default.
    """
    c, volts, high = bench.conditions, bench.volts, int(expected)
    edges: dict[int, list[tuple[float, float, int]]] = {}
    far += max(c.ramp(event.slew) for event in events) / 2
    for pin, when, level, slew in events:
        ramp = c.ramp(slew)
        edges.setdefault(pin, []).append((far + when - ramp / 2, ramp, level))
    output, settings = bench.machine.outputs[0], replace(c.settings, reltol=RELTOL, timeout=PATIENCE)
    load = bench.pressed.get(output, c.least_load)
    after = max(t + ramp for line in edges.values() for t, ramp, _ in line) + bench.settling
    after += bench.patience(output, load)
    try:
        wave, start = bench.run(state, edges, after, after / c.settings.steps, {output: load}, settings=settings)
    except SimulationError:
        return None
    stop = start + after
    if abs(wave.at(output, stop) - high * volts) > c.lower * volts:
        return None
    if state.outputs[0] == expected:
        calm = np.abs(wave.voltage[output][wave.time > start] - high * volts)
        return 0.0 if calm.max() < c.middle * volts else None
    level = edge if edge is not None else next(e.level for e in events if e.pin == trigger)
    here = wave.cross(bench.machine.inputs[trigger], c.middle * volts, bool(level), start)
    there = wave.cross(output, c.middle * volts, bool(high), start)
    return None if here is None or there is None else there - here


def bisect(
    run: Callable[[float], float | None],
    far: float,
    moves: bool,
    degrade: float,
    low: float | None = None,
    guess: float | None = None,
    resolution: float = RESOLUTION,
) -> float:
    """Least x in [low, far] from which on ``run(x)`` is a delay within ``degrade`` of that at ``far``.

    low: -far by default. resolution: of x. guess: of the result, which saves runs. Raises SimulationError when ``run``
    fails at ``far``.
    """
    easy = run(far)
    if easy is None:
        raise SimulationError("the constraint is not kept even far from the clock's edge", "")
    limit = easy + degrade * abs(easy) if moves else 0.0

    def kept(x: float) -> bool:
        delay = run(x)
        return delay is not None and delay <= limit

    least = -far if low is None else low
    if low is not None and kept(low):
        return low
    low, high = _bracket(kept, least, far, guess)
    while high - low > resolution:
        middle = (low + high) / 2
        low, high = (low, middle) if kept(middle) else (middle, high)
    return high


def _bracket(kept: Callable[[float], bool], low: float, high: float, guess: float | None) -> tuple[float, float]:
    """Two points around ``guess``, the constraint not kept at the first, found in steps that grow."""
    if guess is None:
        return low, high
    guess, step = min(max(guess, low), high), NEAR
    if kept(guess):
        while guess > low:
            below = max(guess - step, low)
            if not kept(below):
                return below, guess
            guess, step = below, 4 * step
        return low, low
    while guess < high:
        above = min(guess + step, high)
        if above >= high or kept(above):
            return guess, above
        guess, step = above, 4 * step
    return high, high
