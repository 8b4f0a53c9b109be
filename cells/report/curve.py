"""Error against run time: tolerances, time steps and grids, each against a dense transient of the same netlist."""

import json
from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import TypedDict

import numpy as np

from talbot.base import jobs
from talbot.cells import sources
from talbot.cells.characterize import delay
from talbot.cells.characterize.bench import Bench
from talbot.cells.characterize.cell import axes_of, cpu_seconds
from talbot.cells.characterize.conditions import Conditions
from talbot.cells.characterize.job import cell_of, job
from talbot.cells.spice.settings import Settings

CELLS = ("inv_1", "nand2_1", "buf_2")
SLOW = ("inv_8", "nor2_4", "xor2_1", "dfxtp_1")  # with the default setting only
DEFAULT = "reltol 0.0001, 50 steps"
OFF_GRID = 16  # random points of a table, the same for every setting
DENSE = Settings(reltol=1e-6, trtol=1.0, steps=1000, method="gear")
Truth = tuple[float, float, dict[str, float]]  # slew s, load F, what a dense transient measures there
Setting = tuple[str, float, float, float]  # name, CPU seconds of CELLS, median and 95th percentile of the error, %
CellError = tuple[str, int, float, float]  # of the default setting: cell, values, median and 95th percentile, %


class Tried(TypedDict):
    """A cell with one setting: CPU seconds, and the errors of delay and slew in per cent."""

    name: str
    cell: str
    seconds: float
    error: list[float]


def settings(base: Conditions) -> dict[str, Conditions]:
    """The settings that are compared, the default among them."""
    by_name = {}
    for reltol, steps in product((1e-2, 1e-3, 1e-4, 1e-5, 1e-6), (20, 50, 200)):
        tolerance = replace(base.settings, reltol=reltol, steps=steps)
        by_name[f"reltol {reltol:g}, {steps} steps"] = replace(base, settings=tolerance)
    by_name["trapezoidal, reltol 0.0001, 50 steps"] = replace(base, settings=replace(base.settings, method="trap"))
    for count in (4, 5, 7, 9, 13):
        slews = tuple(float(s) for s in np.geomspace(base.slews[0], base.slews[-1], count))
        by_name[f"grid {count} x {count}, not refined"] = replace(base, slews=slews, loads=count, extra=0)
    for extra in (1, 2, 4, 12):
        by_name[f"grid 7 x 7, up to {extra} more"] = replace(base, extra=extra)
    return by_name


def measure(library: str, conditions: Conditions, store: Path, workers: int) -> list[Tried]:
    """Try CELLS with every setting, SLOW with the default.

    One worker measures them, for the sake of the seconds; the dense transients run in ``workers`` processes.
    """
    process, truths, todo = sources.process(library), [], []
    cell_sources = {name: sources.source(library, name) for name in (*CELLS, *SLOW)}
    for name in cell_sources:
        inputs = OFF_GRID, *job(cell_sources[name], replace(conditions, settings=DENSE), process).inputs
        truths.append(jobs.Job(f"{name}.truth", truth, (library, name, conditions), inputs))
    truths = dict(zip(cell_sources, jobs.run(truths, store, "dense transients", workers), strict=True))
    for name in cell_sources:
        for label, at in (settings(conditions) if name in CELLS else {DEFAULT: conditions}).items():
            arguments = library, name, label, at, truths[name]
            inputs = *job(cell_sources[name], at, process).inputs, json.dumps(truths[name])
            todo.append(jobs.Job(f"{name}.{label.replace(' ', '_')}", one, arguments, inputs))
    return jobs.run(todo, store, "error against run time", workers=1)


def one(library: str, name: str, label: str, conditions: Conditions, truth: Sequence[Sequence[Truth]]) -> Tried:
    """Try one cell with one setting against its ``truth``."""
    cell = cell_of(sources.source(library, name), sources.process(library))
    started = cpu_seconds()
    with Bench(cell, sources.process(library), conditions) as bench:
        grid = {output: axes_of(bench, output) for output in cell.machine.outputs}
        arcs = ((arc.changes[0], arc.output, grid[arc.output]) for arc in cell.arcs)
        tables = [delay.table(bench, change, output, axes.loads, axes.slews) for change, output, axes in arcs]
    seconds, errors = cpu_seconds() - started, []
    for table, points in zip(tables, truth, strict=True):
        for slew, load, exact in points:
            errors += [100 * (table.at(field, slew, load) / exact[field] - 1) for field in ("delay", "slew")]
    return {"name": label, "cell": name, "error": errors, "seconds": seconds}


def truth(library: str, name: str, base: Conditions) -> list[list[Truth]]:
    """Run dense transients at random points of every arc of a cell."""
    rng, values, process = np.random.default_rng(1), [], sources.process(library)
    cell = cell_of(sources.source(library, name), process)
    with Bench(cell, process, replace(base, settings=DENSE)) as bench:
        changes = {output: [a.changes[0] for a in cell.arcs if a.output == output] for output in cell.machine.outputs}
        end = base.slews[-1]
        largest = {output: delay.largest_load(bench, same, output, end) for output, same in changes.items()}
        for arc in cell.arcs:
            slews = np.exp(rng.uniform(np.log(base.slews[0]), np.log(base.slews[-1]), OFF_GRID))
            loads = np.exp(rng.uniform(np.log(base.least_load), np.log(largest[arc.output]), OFF_GRID))
            points = zip(slews.tolist(), loads.tolist(), strict=True)
            values.append([(s, load, vars(bench.edge(arc.changes[0], arc.output, s, load))) for s, load in points])
    return values


def table(tries: Sequence[Tried]) -> list[Setting]:
    """Summarize every setting over CELLS."""
    names = dict.fromkeys(f["name"] for f in tries)
    groups = {name: [f for f in tries if f["name"] == name and f["cell"] in CELLS] for name in names}
    seconds = {name: sum(f["seconds"] for f in same) for name, same in groups.items()}
    return [(name, seconds[name], *spread([e for f in same for e in f["error"]])) for name, same in groups.items()]


def by_cell(tries: Sequence[Tried]) -> list[CellError]:
    """Summarize every cell with the default setting."""
    return [(f["cell"], len(f["error"]), *spread(f["error"])) for f in tries if f["name"] == DEFAULT]


def spread(errors: Sequence[float]) -> tuple[float, float]:
    """Median and 95th percentile of the absolute ``errors``."""
    return float(np.median(np.abs(errors))), float(np.percentile(np.abs(errors), 95))
