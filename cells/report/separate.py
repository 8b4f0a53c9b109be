"""Which part of the error is whose: device models, stray capacitances, the drawn transistors, the tables."""

from dataclasses import replace

import numpy as np

from base import jobs
from cells import sources
from cells.characterize.bench import Bench
from cells.characterize.job import cell_of, job
from cells.liberty import reference

POINTS = slice(0, None, 2)  # of the reference's axes: every other


def variants(process):
    """(models, netlist) of every combination."""
    return [(models, netlist) for models in process.SETS for netlist in sources.NETLISTS]


def separate(library, names, conditions, folder, store, workers):
    """[{cell, models, netlist, delay: errors, slew: errors}] in per cent, at the reference's own points.

    Nothing is interpolated, so that what is left is of models and netlist.
    """
    process = sources.process(library)
    todo = []
    for name in names:
        file = next(folder.glob(f"{name}.lib.json"), None) or next(folder.glob(f"*__{name}__*.lib.json"))
        for models, netlist in variants(process):
            source = sources.source(library, name, netlist)
            at = replace(conditions, models=models)
            inputs = job(source, at, process).inputs
            todo.append(
                jobs.Job(
                    f"{name}.{models}.{netlist}.{conditions.corner.name}",
                    errors,
                    (library, name, at, netlist, str(file)),
                    (*inputs, file),
                )
            )
    return jobs.run(todo, store, "models and netlists", workers)


def errors(library, name, conditions, netlist, file):
    """Errors of delay and slew of one cell in one variant: dict."""
    process = sources.process(library)
    cell, theirs = cell_of(sources.source(library, name, netlist), process), reference.cell(file)
    found = {"cell": name, "models": conditions.models, "netlist": netlist, "delay": [], "slew": []}
    with Bench(cell, process, conditions) as bench:
        for arc in cell.arcs:
            for timing in theirs.one("pin", arc.output).all(
                "timing", related_pin=arc.pin, timing_type=arc.type, timing_sense=arc.sense
            ):
                for field, kind in (("delay", f"cell_{arc.edge}"), ("slew", f"{arc.edge}_transition")):
                    table = timing.one(kind)
                    values = table.array("values")[POINTS, POINTS]
                    ours = [
                        [
                            getattr(bench.edge(arc.changes[0], arc.output, slew * 1e-9, load * 1e-12), field) * 1e9
                            for load in table.array("index_2")[POINTS]
                        ]
                        for slew in table.array("index_1")[POINTS]
                    ]
                    found[field] += np.ravel((np.array(ours) / values - 1) * 100).tolist()
    return found


def table(found):
    """[(models, netlist, entries, median, 95th percentile)] of absolute errors in per cent, delay and slew together."""
    rows = []
    for key in dict.fromkeys((f["models"], f["netlist"]) for f in found):
        values = np.abs([e for f in found if (f["models"], f["netlist"]) == key for e in (*f["delay"], *f["slew"])])
        rows.append((*key, len(values), float(np.median(values)), float(np.percentile(values, 95))))
    return rows
