"""A library characterized at a corner: jobs, files, summary."""

import json
import shutil
import time
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

from talbot.base import jobs
from talbot.base.files import staged, write
from talbot.base.liberty.group import Group
from talbot.base.liberty.write import text
from talbot.base.progress import each
from talbot.cells import sources
from talbot.cells.characterize.conditions import Conditions
from talbot.cells.characterize.job import cell_of, job
from talbot.cells.characterize.measured import Measured
from talbot.cells.liberty import accept, build, compare, reference
from talbot.cells.liberty.check import problems
from talbot.cells.netlist.function import Cell
from talbot.cells.spice.circuit import circuit
from talbot.models.parameters import ParameterError


def characterize_library(
    library: str,
    c: Conditions,
    cell_names: list[str] | None,
    netlist: str,
    out: Path,
    against: Path | None,
    workers: int,
) -> dict[str, Any]:
    """Write <out>/<library>/<corner>.lib, <library>.lef, <library>.v and summary.json; returns the summary.

    summary.json: that of this corner, and under 'corners' that of every corner whose .lib is in the folder; LEF and
    Verilog have the cells of all of them. cell_names: names of cells, None for all. netlist: one of sources.NETLISTS.
    against: folder of SkyWater's tables, with those of other corners perhaps. workers: processes, -1 for all cores.
    """
    started, process, corner, title = time.monotonic(), sources.process(library), c.corner.name, sources.title(library)
    if unknown := sorted(set(cell_names or ()) - set(sources.names(library))):
        raise ParameterError(f"cells = {', '.join(unknown)}: must be of {library}")
    known = reference.folder(against, corner) if against else None
    names = sorted(cell_names or sources.names(library))
    cell_sources = [sources.source(library, name, netlist) for name in each(names, "netlists", str)]
    cells = [cell_of(source, process) for source in each(cell_sources, "functions", lambda source: source.name)]
    for cell in cells:
        _has_models(cell, process, c)
    folder, longest_first = out / title, sorted(cell_sources, key=lambda source: -len(source.netlist))
    todo = [job(source, c, process) for source in longest_first]
    results = jobs.run(todo, folder / "jobs", f"{title} {corner}", workers)
    by_name = {source.name: result for source, result in zip(longest_first, results, strict=True)}
    measured: list[Measured] = [by_name[name] for name in names]
    entries = [build.Entry(cell, m, s.area) for cell, m, s in zip(cells, measured, cell_sources, strict=True)]
    tree = build.library(f"{title}__{corner}", c, entries, process, {} if cell_names else sources.constants(library))
    with staged(folder) as part:
        (part / f"{corner}.lib").write_text(text(tree), encoding="utf-8")
        summary = _summary(measured, tree) | (
            compare.summary(compare.library(tree, known), process.FITTED) if known else {}
        )
        summary |= {"wall_s": round(time.monotonic() - started, 1), "names": names}
        summary["left_out"] = {} if cell_names else sources.left_out(library)
        summary["read_by"] = read_by = accept.readers(part / f"{corner}.lib")
        summary["problems"] += [f"{tool}: {said}" for tool, said in read_by.items() if said not in accept.GOOD]
        corners = _corners(folder) | {corner: dict(summary)}
        for suffix, content in sources.files(library, {n for s in corners.values() for n in s["names"]}).items():
            (part / f"{title}.{suffix}").write_text(content, encoding="utf-8")
        every = {"corner": corner, **summary, "corners": corners}
        (part / "summary.json").write_text(json.dumps(every, indent=1) + "\n", encoding="utf-8")
    _keep_failed(folder / "failed" / corner, measured)
    return summary


def _keep_failed(folder: Path, measured: Sequence[Measured]) -> None:
    """Write the netlists of the failed simulations, and delete those of an earlier run."""
    shutil.rmtree(folder, ignore_errors=True)
    for measure in measured:
        for k, failure in enumerate(measure["failed"]):
            content = f"* {failure['what']}: {failure['why']}\n{failure['deck']}"
            write(folder / f"{measure['name']}.{k}.sp", content)


def _has_models(cell: Cell, process: ModuleType, conditions: Conditions) -> None:
    """Raise ParameterError, before anything runs, when no model covers the size of a transistor of ``cell``."""
    try:
        circuit(cell.machine.netlist, process, conditions.models, conditions.corner)
    except ParameterError as error:
        raise ParameterError(f"netlist = {cell.name}: {error}") from None


def _corners(folder: Path) -> dict[str, dict[str, Any]]:
    """Summaries of the corners of earlier runs whose library is still in the folder."""
    try:
        known = json.loads((folder / "summary.json").read_text(encoding="utf-8")).get("corners", {})
    except (OSError, ValueError, AttributeError):
        return {}
    return {name: summary for name, summary in known.items() if (folder / f"{name}.lib").exists()}


def _summary(measured: Sequence[Measured], tree: Group) -> dict[str, Any]:
    counts = {name: sum(len(m[name]) for m in measured) for name in ("arcs", "constraints")}
    counts |= {name: sum(m[name] for m in measured) for name in ("simulations", "repeated")}
    return {
        "cells": len(measured),
        **counts,
        "failed": [f"{m['name']}: {f['what']}: {f['why']}" for m in measured for f in m["failed"]],
        "problems": problems(tree),
        "cpu_s": round(sum(m["cpu_s"] for m in measured), 1),
        "cell_s": {m["name"]: m["wall_s"] for m in measured},
        "cell_cpu_s": {m["name"]: m["cpu_s"] for m in measured},
    }
