"""Stiff and extreme cases of the characterizer, bound against measured."""

import sys
import time
from argparse import ArgumentParser, Namespace
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
from tqdm import tqdm

from cells import sources
from cells.characterize import delay, tristate
from cells.characterize.bench import Bench
from cells.characterize.conditions import Conditions
from cells.characterize.constraint import PATIENCE, Event, bisect, outcome
from cells.characterize.job import cell_of
from cells.characterize.scenario import Scenarios
from cells.corner import PROCESSES, Corner
from cells.netlist.function import Cell
from models.stability import Case, table

TYPICAL = Conditions(Corner("tt", 25, 1.8), "fitted")
FOUNDRY = (Corner("ss", 100, 1.6), Corner("ff", -40, 1.95))  # corners that SkyWater publishes tables for


def cases() -> list[Case]:
    """All cases; shows a progress bar."""
    todo: list[Callable[[], list[Case]]] = [loads_and_slews, hundred_times_the_load, metastable, let_go]
    todo += [partial(fit_at_corner, corner) for corner in FOUNDRY]
    todo += [
        partial(corner_case, Corner(process, temperature, supply))
        for process in PROCESSES
        for temperature, supply in ((-40, 1.2), (150, 1.2), (-40, 1.95), (150, 1.95))
    ]
    return [case for call in tqdm(todo, desc="cases", file=sys.stderr, disable=None) for case in call()]


def cell(name: str) -> Cell:
    """The cell of sky130_hd as laid out."""
    return cell_of(sources.source("sky130_hd", name), sources.process("sky130_hd"))


def loads_and_slews() -> list[Case]:
    """No load at all, slews of 1 ps and 10 ns: close to the neighbours in the table."""
    out = []
    inverter = cell("inv_1")
    with Bench(inverter, sources.process("sky130_hd"), TYPICAL) as bench:
        for arc in inverter.arcs:
            change = arc.changes[0]
            normal = bench.edge(change, "Y", 10e-12, 0.5e-15)
            bare = bench.edge(change, "Y", 1e-12, 0.0)
            out.append(
                _case(
                    f"inverter {arc.edge}, no load, slew 1 ps",
                    "0 < delay < that at 10 ps and 0.5 fF",
                    bare.delay,
                    0 < bare.delay < normal.delay,
                )
            )
            slow = bench.edge(change, "Y", 10e-9, 0.5e-15)
            out.append(
                _case(
                    f"inverter {arc.edge}, slew 10 ns",
                    "0 < output slew < 3 ns, |delay| < 3 ns",
                    slow.slew,
                    0 < slow.slew < 3e-9 and abs(slow.delay) < 3e-9,
                )
            )
            worst = bench.edge(change, "Y", 10e-9, 0.0)
            out.append(
                _case(
                    f"inverter {arc.edge}, slew 10 ns, no load",
                    "within 20 % of that with 0.5 fF",
                    worst.slew,
                    abs(worst.slew / slow.slew - 1) < 0.2,
                )
            )
    return out


def hundred_times_the_load() -> list[Case]:
    """A hundred times the largest load: a hundred times the slew, within 2 %."""
    out, inverter = [], cell("inv_1")
    with Bench(inverter, sources.process("sky130_hd"), TYPICAL) as bench:
        for arc in inverter.arcs:
            change = arc.changes[0]
            largest = delay.largest_load(bench, [change], "Y")
            one, hundred = (bench.edge(change, "Y", 10e-12, factor * largest).slew for factor in (1, 100))
            out.append(
                _case(
                    f"inverter {arc.edge}, 100 times the largest load",
                    "100 times the slew, within 2 %",
                    hundred,
                    abs(hundred / one / 100 - 1) < 0.02,
                )
            )
    return out


def metastable() -> list[Case]:
    """A flip-flop ever closer to the edge between storing and losing a bit, down to 1 fs: no run takes too long."""
    flip_flop = cell("dfxtp_1")
    (scenario,), longest = Scenarios(flip_flop).setup("D", 1), 0.0
    with Bench(flip_flop, sources.process("sky130_hd"), TYPICAL) as bench:

        def run_at(offset: float) -> float | None:
            nonlocal longest
            started = time.monotonic()
            events = [
                Event(scenario.clock, 0.0, scenario.clock_to, 10e-12),
                Event(scenario.data, -offset, scenario.data_to, 10e-12),
            ]
            found = outcome(bench, scenario.start, events, 1e-9, scenario.trigger, scenario.expected)
            longest = max(longest, time.monotonic() - started)
            return found

        at = bisect(run_at, 1e-9, True, 1e3, resolution=1e-15)
        lost = run_at(at - 2e-15)
    return [
        Case(
            "flip-flop, 1 fs from its metastable edge",
            f"lost 2 fs later, each run under {PATIENCE + 1:.0f} s",
            f"edge at {at * 1e12:.3f} ps, longest run {longest:.2f} s",
            lost is None and longest < PATIENCE + 1,
        )
    ]


def let_go() -> list[Case]:
    """A tri-state output let go, at slews of 1 ps and 10 ns: no earlier or later than half the ramp."""
    buffer, out = cell("ebufn_1"), []
    process = sources.process("sky130_hd")
    with Bench(buffer, process, TYPICAL) as bench, tristate.Held(bench, "Z", process) as held:
        for arc in (a for a in buffer.arcs if a.type == "three_state_disable"):
            fast, slow = (held.let_go(arc.changes[0], slew) for slew in (1e-12, 10e-9))
            out.append(
                _case(
                    f"tri-state let go from {'low' if arc.edge == 'rise' else 'high'}, slew 10 ns",
                    "0 < time at 1 ps < 0.5 ns; at 10 ns within half the ramp of it",
                    slow,
                    0 < fast < 0.5e-9 and abs(slow - fast) < TYPICAL.ramp(10e-9) / 2,
                )
            )
    return out


def fit_at_corner(corner: Corner) -> list[Case]:
    """How much slower or faster than typical a corner is, with the fitted models and with the binned ones."""
    out, process = [], sources.process("sky130_hd")
    for name, output in (("nand2_1", "Y"), ("dfxtp_1", "Q")):
        tested, ratio = cell(name), {}
        for models in ("binned", "fitted"):
            seconds = []
            for at in (TYPICAL.corner, corner):
                with Bench(tested, process, replace(TYPICAL, corner=at, models=models)) as bench:
                    seconds.append(
                        sum(bench.edge(arc.changes[0], output, 0.12e-9, 10e-15).delay for arc in tested.arcs)
                    )
            ratio[models] = seconds[1] / seconds[0]
        slow = corner.process == "ss"
        out.append(
            Case(
                f"{name}, {corner.name} over {TYPICAL.corner.name}",
                "that of the binned models, within 3 %",
                f"{ratio['fitted']:.3f}, binned {ratio['binned']:.3f}",
                (ratio["fitted"] > 1) == slow and abs(ratio["fitted"] / ratio["binned"] - 1) < 0.03,
            )
        )
    return out


def corner_case(corner: Corner) -> list[Case]:
    """A NAND gate at a corner: a small table that rises with the load, and a flip-flop that stores."""
    conditions = replace(TYPICAL, corner=corner)
    nand = cell("nand2_1")
    rises, longest = True, 0.0
    with Bench(nand, sources.process("sky130_hd"), conditions) as bench:
        for arc in nand.arcs:
            found = delay.table(bench, arc.changes[0], "Y", (0.5e-15, 10e-15, 100e-15), (10e-12, 0.3e-9, 1.5e-9))
            for values in (found.values["delay"], found.values["slew"]):
                rises &= bool((np.diff(values, axis=1) > 0).all())
            longest = max(longest, float(found.values["delay"].max()))
    flip_flop = cell("dfxtp_1")
    with Bench(flip_flop, sources.process("sky130_hd"), conditions) as bench:
        stored = [bench.edge(arc.changes[0], "Q", 0.1e-9, 10e-15).delay for arc in flip_flop.arcs]
    return [
        Case(
            f"NAND and flip-flop at {corner.name}",
            "delays and slews rise with the load; 0 < clock to Q < 100 ns",
            f"longest {longest * 1e9:.2f} ns, clock to Q {max(stored) * 1e9:.2f} ns",
            rises and min(stored) > 0 and max(stored) < 100e-9,
        )
    ]


def _case(name: str, bound: str, seconds: float, ok: bool | np.bool_) -> Case:
    return Case(name, bound, f"{seconds * 1e12:.1f} ps", bool(ok))


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot cells-stability`: none."""


def run(options: Namespace) -> int:
    """Print the table of all cases; 1 where a bound is missed."""
    found = cases()
    print(table(found))
    return 0 if all(case.ok for case in found) else 1
