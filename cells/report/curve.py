"""Error against run time: tolerances, time steps and grids, each against a dense transient of the same netlist."""

import json
from dataclasses import replace

import numpy as np

from base import jobs
from cells import sources
from cells.characterize import delay
from cells.characterize.bench import Bench
from cells.characterize.cell import axes_of, cpu_seconds
from cells.characterize.job import cell_of, job
from cells.spice.settings import Settings

CELLS = ("inv_1", "nand2_1", "buf_2")
SLOW = ("inv_8", "nor2_4", "xor2_1", "dfxtp_1")  # with the default setting alone
DEFAULT = "reltol 0.0001, 50 steps"
OFF_GRID = 16  # random points of a table, the same for every setting
DENSE = Settings(reltol=1e-6, trtol=1.0, steps=1000, method="gear")


def settings(conditions):
    """name -> Conditions: what is compared. The default is among them."""
    base, found = conditions, {}
    for reltol in (1e-2, 1e-3, 1e-4, 1e-5, 1e-6):
        for steps in (20, 50, 200):
            found[f"reltol {reltol:g}, {steps} steps"] = replace(
                base, settings=replace(base.settings, reltol=reltol, steps=steps)
            )
    found["trapezoidal, reltol 0.0001, 50 steps"] = replace(base, settings=replace(base.settings, method="trap"))
    for count in (4, 5, 7, 9, 13):
        slews = tuple(float(s) for s in np.geomspace(base.slews[0], base.slews[-1], count))
        found[f"grid {count} x {count}, not refined"] = replace(base, slews=slews, loads=count, extra=0)
    for extra in (1, 2, 4, 12):
        found[f"grid 7 x 7, up to {extra} more"] = replace(base, extra=extra)
    return found


def measure(library, conditions, store, workers):
    """[{name, cell, seconds of the processor, error: of delay and slew, per cent}]: CELLS with every setting, SLOW with

    the default. By one worker, for the sake of the seconds; what they are held against by ``workers``.
    """
    process, cells = sources.process(library), (*CELLS, *SLOW)
    found = {name: sources.source(library, name) for name in cells}
    truths = [
        jobs.Job(
            f"{name}.truth",
            truth,
            (library, name, conditions),
            (OFF_GRID, *job(found[name], replace(conditions, settings=DENSE), process).inputs),
        )
        for name in cells
    ]
    truths = dict(zip(cells, jobs.run(truths, store, "dense transients", workers), strict=True))
    todo = []
    for name in cells:
        tried = settings(conditions) if name in CELLS else {DEFAULT: conditions}
        todo += [
            jobs.Job(
                f"{name}.{label.replace(' ', '_')}",
                one,
                (library, name, label, at, truths[name]),
                (*job(found[name], at, process).inputs, json.dumps(truths[name])),
            )
            for label, at in tried.items()
        ]
    return jobs.run(todo, store, "error against run time", workers=1)


def one(library, name, label, conditions, truth):
    """One cell with one setting, against its ``truth``: dict."""
    cell = cell_of(sources.source(library, name), sources.process(library))
    found = {"name": label, "cell": name, "error": []}
    started = cpu_seconds()
    with Bench(cell, sources.process(library), conditions) as bench:
        grid = {output: axes_of(bench, output) for output in cell.machine.outputs}
        tables = [
            delay.table(bench, arc.changes[0], arc.output, grid[arc.output][1], grid[arc.output][0])
            for arc in cell.arcs
        ]
    found["seconds"] = cpu_seconds() - started
    for table, points in zip(tables, truth, strict=True):
        for slew, load, exact in points:
            found["error"] += [100 * (table.at(field, slew, load) / exact[field] - 1) for field in ("delay", "slew")]
    return found


def truth(library, name, base):
    """For every arc of a cell [(slew, load, {delay, slew})]: dense transients at random points."""
    rng, found = np.random.default_rng(1), []
    process = sources.process(library)
    cell = cell_of(sources.source(library, name), process)
    with Bench(cell, process, replace(base, settings=DENSE)) as bench:
        largest = {
            output: delay.largest_load(bench, [a.changes[0] for a in cell.arcs if a.output == output], output)
            for output in cell.machine.outputs
        }
        for arc in cell.arcs:
            slews = np.exp(rng.uniform(*np.log([base.slews[0], base.slews[-1]]), OFF_GRID))
            loads = np.exp(rng.uniform(*np.log([base.least_load, largest[arc.output]]), OFF_GRID))
            found.append(
                [
                    (slew, load, vars(bench.edge(arc.changes[0], arc.output, slew, load)))
                    for slew, load in zip(slews.tolist(), loads.tolist(), strict=True)
                ]
            )
    return found


def table(found):
    """[(setting, seconds of CELLS, median, 95th percentile)] of absolute errors in per cent."""
    rows = []
    for name in dict.fromkeys(f["name"] for f in found):
        same = [f for f in found if f["name"] == name and f["cell"] in CELLS]
        values = np.abs(np.concatenate([f["error"] for f in same]))
        rows.append((name, sum(f["seconds"] for f in same), float(np.median(values)), float(np.percentile(values, 95))))
    return rows


def by_cell(found):
    """[(cell, points, median, 95th percentile)] of absolute errors in per cent with the default setting."""
    own = [(f["cell"], np.abs(f["error"])) for f in found if f["name"] == DEFAULT]
    return [(cell, len(errors), float(np.median(errors)), float(np.percentile(errors, 95))) for cell, errors in own]
