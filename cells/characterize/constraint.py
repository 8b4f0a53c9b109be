"""Setup, hold, recovery, removal and the shortest pulses, by bisection.

A constraint is kept while the output ends where it should and, if it moves, takes at most Conditions.degrade longer
than without any pressure. Near the edge a flip-flop hangs between its levels for as long as one likes: a run that
has not settled by its end, or not finished by its time-out, does not keep the constraint.

The output carries the load at two thirds of its axis: with it SkyWater's setup and hold times come out within 15 ps;
with the least load those of a rising output are 20 to 50 ps longer, for its delay may grow by less.
"""

from dataclasses import replace

import numpy as np

from cells.characterize.scenario import Scenarios
from cells.spice.engine import SimulationError

RESOLUTION = 2e-12  # s, of a bisection
RELTOL = 1e-3  # moves a setup time by less than 1 ps, and takes half the time of 1e-4
NEAR = 16e-12  # s, first step away from a guess
PATIENCE = 5.0  # s of run time for one run of a search
FAR = 1.0  # share of the settling time in which a constraint lies, beyond the ramps


def constraints(bench, tried):
    """Every constraint of a cell with storage: list of dict(pin, related, type, slews, rise, fall)."""
    cell, found = bench.cell, []
    scenarios, storage = Scenarios(cell), cell.storage
    edge = "rising" if bool(storage.active) != (storage.kind == "latch") else "falling"
    for pin in storage.data_pins:
        for kind, scenario in (("setup", scenarios.setup), ("hold", scenarios.hold)):
            by_edge = {name: scenario(pin, level) for level, name in ((1, "rise"), (0, "fall"))}
            found.append(_searched(bench, tried, pin, storage.clock, f"{kind}_{edge}", by_edge))
    for pin, level in filter(None, (storage.clear, storage.preset)):
        for kind, early in (("recovery", True), ("removal", False)):
            by_edge = {"fall" if level else "rise": scenarios.release(pin, early)}
            found.append(_searched(bench, tried, pin, storage.clock, f"{kind}_{edge}", by_edge))
    pulses = {(pin, level) for pin, level in filter(None, (storage.clear, storage.preset))}
    pulses |= {(storage.clock, level) for level in ((0, 1) if storage.kind != "latch" else (storage.active,))}
    for pin in sorted({pin for pin, _ in pulses}):
        widths = {
            ("fall", "rise")[level]: tried(f"{pin}: pulse to {level}", _widths, bench, scenarios, pin, level)
            for other, level in sorted(pulses)
            if other == pin
        }
        found.append(
            {
                "pin": pin,
                "related": pin,
                "type": "min_pulse_width",
                "slews": bench.conditions.constraint_slews,
                **widths,
            }
        )
    return [f for f in found if f.get("rise") is not None or f.get("fall") is not None]


def _searched(bench, tried, pin, related, kind, by_edge):
    found = {"pin": pin, "related": related, "type": kind, "slews": bench.conditions.constraint_slews}
    for name, scenarios in by_edge.items():
        if scenarios:
            found[name] = tried(f"{pin} {name}: {kind}", _longest, bench, scenarios)
    return found


def _longest(bench, scenarios):
    """What every one of ``scenarios`` needs: the longest time for each pair of slews."""
    return np.max([_times(bench, scenario) for scenario in scenarios], axis=0).tolist()


def _times(bench, scenario):
    """(slews of the clock, slews of the data) of least times between the two edges, s."""
    slews, table = bench.conditions.constraint_slews, []
    for i, clock in enumerate(slews):
        row = []
        for j, data in enumerate(slews):
            guess = (table[i - 1][j] + (row[j - 1] - table[i - 1][j - 1] if j else 0)) if i else None
            row.append(_time(bench, scenario, clock, data, guess))
        table.append(row)
    return table


def _time(bench, scenario, clock_slew, data_slew, guess):
    """Least time from data to clock (setup, recovery) or from clock to data (hold, removal), between 50 % points."""
    ramps = bench.conditions.ramp(clock_slew) + bench.conditions.ramp(data_slew)
    far = FAR * bench.settling + ramps
    sign = -1 if scenario.early else 1

    def run(offset):
        events = [
            (scenario.clock, 0.0, scenario.clock_to, clock_slew),
            (scenario.data, sign * offset, scenario.data_to, data_slew),
        ]
        return outcome(bench, scenario.start, events, far, scenario.trigger, scenario.expected)

    return bisect(run, far, scenario.moves, bench.conditions.degrade, guess=guess)


def _widths(bench, scenarios, pin, level):
    """Shortest pulse in s for every slew, between 50 % points: a ramp at least, and what the slower level needs."""
    found = [_shortest(bench, scenarios, pin, level, *case) for case in scenarios.pulses(pin, level)]
    return np.max(found, axis=0).tolist() if found else None


def _shortest(bench, scenarios, pin, level, state, expected):
    number = bench.machine.inputs.index(pin)
    widths = []
    for slew in bench.conditions.constraint_slews:
        ramp = bench.conditions.ramp(slew)
        far = FAR * bench.settling + 2 * ramp
        moved_first = scenarios.after[state, number].outputs[0] == expected

        def run(width, slew=slew, far=far, first=moved_first):
            events = [(number, 0.0, level, slew), (number, width, 1 - level, slew)]
            return outcome(bench, state, events, far, number, expected, edge=level if first else 1 - level)

        widths.append(bisect(run, far, True, bench.conditions.degrade, low=ramp))
    return widths


def outcome(bench, state, events, far, trigger, expected, edge=None):
    """Delay of the first output in s, 0.0 when it stays as it should, None when it does not end as expected.

    events: (input number, time of its 50 % point after the clock's, level, slew). edge: of the trigger, else its last.
    """
    c, volts = bench.conditions, bench.volts
    edges = {}
    far += max(c.ramp(slew) for *_, slew in events) / 2
    for pin, when, level, slew in events:
        ramp = c.ramp(slew)
        edges.setdefault(pin, []).append((far + when - ramp / 2, ramp, level))
    output = bench.machine.outputs[0]
    load = bench.pressed.get(output, c.least_load)
    after = max(t + ramp for line in edges.values() for t, ramp, _ in line) + bench.settling
    after += bench.patience(output, load)
    try:
        wave, start = bench.run(
            state,
            edges,
            after,
            after / c.settings.steps,
            {output: load},
            settings=replace(c.settings, reltol=RELTOL, timeout=PATIENCE),
            retry=False,
        )
    except SimulationError:
        return None
    stop = start + after
    if abs(wave.at(output, stop) - expected * volts) > c.lower * volts:
        return None
    if state.outputs[0] == expected:
        calm = np.abs(wave.voltage[output][wave.time > start] - expected * volts)
        return 0.0 if calm.max() < c.middle * volts else None
    level = edge if edge is not None else events[[e[0] for e in events].index(trigger)][2]
    here = wave.cross(bench.machine.inputs[trigger], c.middle * volts, bool(level), start)
    there = wave.cross(output, c.middle * volts, bool(expected), start)
    return None if here is None or there is None else there - here


def bisect(run, far, moves, degrade, low=None, guess=None, resolution=RESOLUTION):
    """Least x in [low, far] from which on ``run(x)`` is a delay within ``degrade`` of that at ``far``.

    low: -far when not given. resolution: of x. guess: where it may lie, which saves runs. Raises SimulationError when
    even ``far`` does not do.
    """
    easy = run(far)
    if easy is None:
        raise SimulationError("the constraint is not kept even far from the clock's edge", "")
    limit = easy + degrade * abs(easy) if moves else 0.0

    def kept(x):
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


def _bracket(kept, low, high, guess):
    """(not kept, kept) around ``guess``, found in steps that grow."""
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
