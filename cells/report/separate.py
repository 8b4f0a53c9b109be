"""Sources of the error: device models, parasitics, the drawn transistors."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import NamedTuple, TypedDict

import numpy as np

from base import jobs
from cells import sources
from cells.characterize.bench import Bench
from cells.characterize.conditions import Conditions
from cells.characterize.job import cell_of, job
from cells.liberty import reference

POINTS = slice(0, None, 2)  # of the reference's axes: every other


class Errors(TypedDict):
    """Errors of delay and slew of one cell in one variant, per cent."""

    cell: str
    models: str
    netlist: str
    delay: list[float]
    slew: list[float]


class Variant(NamedTuple):
    """Absolute errors of delay and slew in per cent with a set of models and a netlist."""

    models: str
    netlist: str
    entries: int
    median: float
    p95: float


def variants(process: ModuleType) -> list[tuple[str, str]]:
    """Every combination of a set of models and a netlist."""
    return [(models, netlist) for models in process.SETS for netlist in sources.NETLISTS]


def separate(
    library: str, names: Sequence[str], conditions: Conditions, folder: Path, store: Path, workers: int
) -> list[Errors]:
    """Errors of every cell in every variant, at the reference's own points.

    Nothing is interpolated, so that only models and netlist cause them.
    """
    process = sources.process(library)
    todo = []
    for name in names:
        file = next(folder.glob(f"{name}.lib.json"), None) or next(folder.glob(f"*__{name}__*.lib.json"))
        for models, netlist in variants(process):
            source, at = sources.source(library, name, netlist), replace(conditions, models=models)
            arguments, inputs = (library, name, at, netlist, str(file)), (*job(source, at, process).inputs, file)
            title = f"{name}.{models}.{netlist}.{conditions.corner.name}"
            todo.append(jobs.Job(title, errors, arguments, inputs))
    return jobs.run(todo, store, "models and netlists", workers)


def errors(library: str, name: str, conditions: Conditions, netlist: str, file: str) -> Errors:
    """Errors of one cell in one variant, against the reference's ``file``."""
    process = sources.process(library)
    cell, theirs = cell_of(sources.source(library, name, netlist), process), reference.cell(file)
    found: Errors = {"cell": name, "models": conditions.models, "netlist": netlist, "delay": [], "slew": []}
    with Bench(cell, process, conditions) as bench:
        for arc in cell.arcs:
            pin = theirs.one("pin", arc.output)
            wanted = {"related_pin": arc.pin, "timing_type": arc.type, "timing_sense": arc.sense}
            for timing in pin.all("timing", **wanted) if pin else ():
                for field, kind in (("delay", f"cell_{arc.edge}"), ("slew", f"{arc.edge}_transition")):
                    table = timing.one(kind)
                    if table is None:
                        continue
                    values, change = table.array("values")[POINTS, POINTS], arc.changes[0]
                    slews, loads = (table.array(f"index_{k}")[POINTS] for k in (1, 2))
                    edges = [[bench.edge(change, arc.output, s * 1e-9, f * 1e-12) for f in loads] for s in slews]
                    ours = [[getattr(edge, field) * 1e9 for edge in row] for row in edges]
                    found[field] += np.ravel((np.array(ours) / values - 1) * 100).tolist()
    return found


def table(found: Sequence[Errors]) -> list[Variant]:
    """Summarize every variant over all cells, delay and slew together."""
    rows = []
    for models, netlist in dict.fromkeys((f["models"], f["netlist"]) for f in found):
        same = [f for f in found if (f["models"], f["netlist"]) == (models, netlist)]
        values = np.abs([e for f in same for e in (*f["delay"], *f["slew"])])
        rows.append(Variant(models, netlist, len(values), float(np.median(values)), float(np.percentile(values, 95))))
    return rows
