"""Sources of the error: device models, parasitics, the drawn transistors."""

from collections.abc import Container, Mapping, Sequence
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import TypedDict

import numpy as np

from talbot.base import jobs
from talbot.cells import sources
from talbot.cells.characterize import delay
from talbot.cells.characterize.bench import Bench
from talbot.cells.characterize.conditions import Conditions
from talbot.cells.characterize.job import cell_of, job
from talbot.cells.liberty import reference
from talbot.cells.report.curve import spread

POINTS = slice(0, None, 2)  # of the reference's axes: every other
Variant = tuple[str, str, int, float, float]  # models, netlist, entries, median and 95th percentile of the error, %


class Errors(TypedDict):
    """Errors of delay and slew of one cell in one variant, per cent."""

    cell: str
    models: str
    netlist: str
    delay: list[float]
    slew: list[float]


def separate(
    library: str, files: Mapping[str, Path], conditions: Conditions, store: Path, workers: int
) -> list[Errors]:
    """Errors of every cell of ``files`` in every variant, at the reference's own points.

    Nothing is interpolated, so that only models and netlist cause them.
    """
    process = sources.process(library)
    todo = []
    for name, file in files.items():
        for models, netlist in product(process.SETS, sources.NETLISTS):
            source, at = sources.source(library, name, netlist), replace(conditions, models=models)
            arguments, inputs = (library, name, at, netlist, str(file)), (*job(source, at, process).inputs, file)
            title = f"{name}.{models}.{netlist}.{conditions.corner.name}"
            todo.append(jobs.Job(title, errors, arguments, inputs))
    return jobs.run(todo, store, "models and netlists", workers)


def errors(library: str, name: str, conditions: Conditions, netlist: str, file: str) -> Errors:
    """Errors of one cell in one variant, against the reference's ``file``."""
    process = sources.process(library)
    cell, theirs = cell_of(sources.source(library, name, netlist), process), reference.cell(file)
    record: Errors = {"cell": name, "models": conditions.models, "netlist": netlist, "delay": [], "slew": []}
    with Bench(cell, process, conditions) as bench:
        for arc in cell.arcs:
            pin = theirs.one("pin", arc.output)
            attributes = {"related_pin": arc.pin, "timing_type": arc.type, "timing_sense": arc.sense}
            for timing in pin.all("timing", **attributes) if pin else ():
                middle = timing.one(f"cell_{arc.edge}")
                if middle is None:
                    continue
                change = delay.chosen(bench, arc, 1e-12 * float(middle.array("index_2")[3]))
                for field, kind in (("delay", f"cell_{arc.edge}"), ("slew", f"{arc.edge}_transition")):
                    table = timing.one(kind)
                    if table is None:
                        continue
                    values = table.array("values")[POINTS, POINTS]
                    slews, loads = (table.array(f"index_{k}")[POINTS] for k in (1, 2))
                    edges = [[bench.edge(change, arc.output, s * 1e-9, f * 1e-12) for f in loads] for s in slews]
                    ours = [[getattr(edge, field) * 1e9 for edge in row] for row in edges]
                    record[field] += np.ravel((np.array(ours) / values - 1) * 100).tolist()
    return record


def table(records: Sequence[Errors], fitted: Container[str] = ()) -> list[Variant]:
    """Summarize every variant over all cells but those ``fitted``, delay and slew together."""
    errors: dict[tuple[str, str], list[float]] = {}
    for f in (f for f in records if f["cell"] not in fitted):
        errors.setdefault((f["models"], f["netlist"]), []).extend((*f["delay"], *f["slew"]))
    return [(*variant, len(values), *spread(values)) for variant, values in errors.items()]
