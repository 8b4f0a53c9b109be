"""Stiff and extreme cases of the characterizer, bound against measured."""

import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from itertools import product

import numpy as np

from talbot.cells import sources
from talbot.cells.characterize import delay, tristate
from talbot.cells.characterize.bench import Bench
from talbot.cells.characterize.conditions import Conditions
from talbot.cells.characterize.constraint import PATIENCE, Event, bisect, outcome
from talbot.cells.characterize.job import cell_of
from talbot.cells.characterize.scenario import Scenarios
from talbot.cells.corner import PROCESSES, Corner
from talbot.cells.netlist.function import Cell
from talbot.models.stability import Case

PROCESS = sources.process("sky130_hd")
TYPICAL = Conditions(Corner("tt", 25, 1.8), "fitted")
FOUNDRY = (Corner("ss", 100, 1.6), Corner("ff", -40, 1.95))  # corners that SkyWater publishes tables for


def groups() -> Mapping[str, Callable[[], Iterable[Case]]]:
    """Return functions that measure the cases, by title."""
    corners = [Corner(*corner) for corner in product(PROCESSES, (-40, 150), (1.2, 1.95))]
    return (
        {"loads and slews": loads_and_slews, "100 times the load": hundred_times_the_load}
        | {"metastable flip-flop": metastable, "tri-state output": let_go}
        | {f"fit at {corner.name}": partial(fit_at_corner, corner) for corner in FOUNDRY}
        | {f"corner {corner.name}": partial(corner_case, corner) for corner in corners}
    )


def cell(name: str) -> Cell:
    """The cell of sky130_hd as laid out."""
    return cell_of(sources.source("sky130_hd", name), PROCESS)


def loads_and_slews() -> Iterator[Case]:
    """No load at all, slews of 1 ps and 10 ns: close to the neighbours in the table."""
    inverter = cell("inv_1")
    with Bench(inverter, PROCESS, TYPICAL) as bench:
        for arc in inverter.arcs:
            name, change = f"inverter {arc.edge}", arc.changes[0]
            normal, bare = (bench.edge(change, "Y", *point) for point in ((10e-12, 0.5e-15), (1e-12, 0.0)))
            slow, worst = (bench.edge(change, "Y", 10e-9, load) for load in (0.5e-15, 0.0))
            ok, bound = 0 < bare.delay < normal.delay, "0 < delay < that at 10 ps and 0.5 fF"
            yield _case(f"{name}, no load, slew 1 ps", bound, bare.delay, ok)
            ok, bound = 0 < slow.slew < 3e-9 and abs(slow.delay) < 3e-9, "0 < output slew < 3 ns, |delay| < 3 ns"
            yield _case(f"{name}, slew 10 ns", bound, slow.slew, ok)
            ok, bound = abs(worst.slew / slow.slew - 1) < 0.2, "within 20 % of that with 0.5 fF"
            yield _case(f"{name}, slew 10 ns, no load", bound, worst.slew, ok)


def hundred_times_the_load() -> Iterator[Case]:
    """A hundred times the largest load: a hundred times the slew, within 2 %."""
    inverter = cell("inv_1")
    with Bench(inverter, PROCESS, TYPICAL) as bench:
        for arc in inverter.arcs:
            change, name = arc.changes[0], f"inverter {arc.edge}, 100 times the largest load"
            largest = delay.largest_load(bench, [change], "Y", TYPICAL.longest_slew)
            single, hundred = (bench.edge(change, "Y", 10e-12, factor * largest).slew for factor in (1, 100))
            yield _case(name, "100 times the slew, within 2 %", hundred, abs(hundred / single / 100 - 1) < 0.02)


def metastable() -> Iterator[Case]:
    """A flip-flop ever closer to the edge between storing and losing a bit, down to 1 fs: no run takes too long."""
    flip_flop = cell("dfxtp_1")
    (scenario,), longest = Scenarios(flip_flop).setup("D", 1), 0.0
    with Bench(flip_flop, PROCESS, TYPICAL) as bench:

        def run_at(offset: float) -> float | None:
            nonlocal longest
            started, clock = time.monotonic(), Event(scenario.clock, 0.0, scenario.clock_to, 10e-12)
            events = [clock, Event(scenario.data, -offset, scenario.data_to, 10e-12)]
            result = outcome(bench, scenario.start, events, 1e-9, scenario.trigger, scenario.expected)
            longest = max(longest, time.monotonic() - started)
            return result

        at = bisect(run_at, 1e-9, True, 1e3, resolution=1e-15)
        lost = run_at(at - 2e-15)
    bound = f"lost 2 fs later, each run under {PATIENCE + 1:.0f} s"
    text = f"edge at {at * 1e12:.3f} ps, longest run {longest:.2f} s"
    yield Case("flip-flop, 1 fs from its metastable edge", bound, text, lost is None and longest < PATIENCE + 1)


def let_go() -> Iterator[Case]:
    """A tri-state output let go, at slews of 1 ps and 10 ns: no earlier or later than half the ramp."""
    buffer, bound = cell("ebufn_1"), "0 < time at 1 ps < 0.5 ns; at 10 ns within half the ramp of it"
    with Bench(buffer, PROCESS, TYPICAL) as bench, tristate.Held(bench, "Z", PROCESS) as held:
        for arc in (a for a in buffer.arcs if a.type == "three_state_disable"):
            fast, slow = (held.let_go(arc.changes[0], slew) for slew in (1e-12, 10e-9))
            name = f"tri-state let go from {'low' if arc.edge == 'rise' else 'high'}, slew 10 ns"
            yield _case(name, bound, slow, 0 < fast < 0.5e-9 and abs(slow - fast) < TYPICAL.ramp(10e-9) / 2)


def fit_at_corner(corner: Corner) -> Iterator[Case]:
    """Compare a corner's delays with typical ones, with the fitted and with the binned models."""
    for name, output in (("nand2_1", "Y"), ("dfxtp_1", "Q")):
        tested, ratio = cell(name), {}
        for models in ("binned", "fitted"):
            seconds = []
            for at in (TYPICAL.corner, corner):
                with Bench(tested, PROCESS, replace(TYPICAL, corner=at, models=models)) as bench:
                    edges = [bench.edge(arc.changes[0], output, 0.12e-9, 10e-15) for arc in tested.arcs]
                seconds.append(sum(edge.delay for edge in edges))
            ratio[models] = seconds[1] / seconds[0]
        title, text = f"{name}, {corner.name} over {TYPICAL.corner.name}", "{fitted:.3f}, binned {binned:.3f}"
        ok = (ratio["fitted"] > 1) == (corner.process == "ss") and abs(ratio["fitted"] / ratio["binned"] - 1) < 0.03
        yield Case(title, "that of the binned models, within 3 %", text.format(**ratio), ok)


def corner_case(corner: Corner) -> Iterator[Case]:
    """A NAND gate at a corner: a small table that rises with the load, and a flip-flop that stores."""
    conditions, nand, flip_flop = replace(TYPICAL, corner=corner), cell("nand2_1"), cell("dfxtp_1")
    rises, longest = True, 0.0
    with Bench(nand, PROCESS, conditions) as bench:
        for arc in nand.arcs:
            slews = delay.table(bench, arc.changes[0], "Y", (0.5e-15, 10e-15, 100e-15), (10e-12, 0.3e-9, 1.5e-9))
            rises &= all((np.diff(slews.values[field], axis=1) > 0).all() for field in ("delay", "slew"))
            longest = max(longest, float(slews.values["delay"].max()))
    with Bench(flip_flop, PROCESS, conditions) as bench:
        stored = [bench.edge(arc.changes[0], "Q", 0.1e-9, 10e-15).delay for arc in flip_flop.arcs]
    bound, ok = "delays and slews rise with the load; 0 < clock to Q < 100 ns", min(stored) > 0 and max(stored) < 100e-9
    text = f"longest {longest * 1e9:.2f} ns, clock to Q {max(stored) * 1e9:.2f} ns"
    yield Case(f"NAND and flip-flop at {corner.name}", bound, text, rises and ok)


def _case(name: str, bound: str, seconds: float, ok: bool | np.bool_) -> Case:
    return Case(name, bound, f"{seconds * 1e12:.1f} ps", bool(ok))
