"""A library at a corner: jobs, files, summary."""

import json
import shutil
import time
from pathlib import Path

from tqdm import tqdm

from base import jobs
from base.files import staged
from base.liberty import write
from cells import sources
from cells.characterize.job import cell_of, job
from cells.liberty import accept, build, compare, reference
from cells.liberty import check as check_library
from cells.spice.circuit import circuit
from models.parameters import ParameterError


def run(library, conditions, wanted, netlist, out, against, workers, started):
    """Characterize and write <out>/<library>/<corner>.lib, <library>.lef, <library>.v and summary.json: the summary.

    summary.json: that of this corner, and of every corner whose .lib lies there under 'corners'; LEF and Verilog have
    the cells of all of them.

    wanted: names, or None for all. netlist: as in sources.NETLISTS. against: folder of SkyWater's tables, or None.
    """
    process, name = sources.process(library), conditions.corner.name
    everything = sources.names(library)
    if unknown := sorted(set(wanted or ()) - set(everything)):
        raise ParameterError(f"cells = {', '.join(unknown)}: must be of {library}")
    known = reference.folder(against) if against else None
    found = [sources.source(library, cell, netlist) for cell in tqdm(wanted or everything, "netlists", disable=None)]
    found.sort(key=lambda source: -len(source.netlist))  # what takes longest goes first
    cells = [cell_of(source, process) for source in tqdm(found, "functions", disable=None)]
    for cell in cells:
        _has_models(cell, process, conditions)
    title = sources.title(library)
    folder = Path(out) / title
    measured = jobs.run(
        [job(source, conditions, process) for source in found], folder / "jobs", f"{title} {name}", workers
    )
    by_name = sorted(zip(cells, measured, found, strict=True), key=lambda entry: entry[2].name)
    cells, measured, found = zip(*by_name, strict=True)
    tree = build.library(
        f"{title}__{name}",
        conditions,
        [(c, m, s.area) for c, m, s in by_name],
        process,
        {} if wanted else sources.constants(library),
    )
    summary = _summary(cells, measured, tree, known, time.monotonic() - started)
    with staged(folder) as part:
        (part / f"{name}.lib").write_text(write.text(tree) + "\n")
        summary |= {
            "names": [s.name for s in found],
            "left_out": {} if wanted else sources.left_out(library),
            "read_by": accept.readers(part / f"{name}.lib"),
        }
        summary["problems"] += [
            f"{tool}: {said}" for tool, said in summary["read_by"].items() if said not in accept.GOOD
        ]
        corners = _corners(folder) | {name: dict(summary)}
        for suffix, text in sources.files(library, {n for s in corners.values() for n in s["names"]}).items():
            (part / f"{title}.{suffix}").write_text(text)
        (part / "summary.json").write_text(json.dumps({"corner": name, **summary, "corners": corners}, indent=1) + "\n")
    _keep_failed(folder / "failed" / name, measured)
    return summary


def _keep_failed(folder, measured):
    """Netlists of the simulations that failed, in place of those of an earlier run."""
    shutil.rmtree(folder, ignore_errors=True)
    for measure in measured:
        for k, failure in enumerate(measure["failed"]):
            folder.mkdir(parents=True, exist_ok=True)
            (folder / f"{measure['name']}.{k}.sp").write_text(
                f"* {failure['what']}: {failure['why']}\n{failure['deck']}"
            )


def _has_models(cell, process, conditions):
    """Raise ParameterError, before anything runs, when a transistor of ``cell`` has a size that no model is for."""
    try:
        circuit(cell.machine.netlist, process, conditions.models, conditions.corner)
    except ParameterError as error:
        raise ParameterError(f"netlist = {cell.name}: {error}") from None


def _corners(folder):
    """{corner: summary} of earlier runs whose library is still there."""
    try:
        known = json.loads((folder / "summary.json").read_text()).get("corners", {})
    except (OSError, ValueError):
        return {}
    return {name: summary for name, summary in known.items() if (folder / f"{name}.lib").exists()}


def _summary(cells, measured, tree, known, seconds):
    failed = [f"{m['name']}: {f['what']}: {f['why']}" for m in measured for f in m["failed"]]
    summary = {
        "cells": len(cells),
        "arcs": sum(len(m["arcs"]) for m in measured),
        "constraints": sum(len(m["constraints"]) for m in measured),
        "simulations": sum(m["simulations"] for m in measured),
        "repeated": sum(m["repeated"] for m in measured),
        "failed": failed,
        "problems": check_library.problems(tree),
        "wall_s": round(seconds, 1),
        "cpu_s": round(sum(m["cpu_s"] for m in measured), 1),
        "cell_s": {m["name"]: m["wall_s"] for m in measured},
        "cell_cpu_s": {m["name"]: m["cpu_s"] for m in measured},
    }
    if known:
        summary |= compare.summary(compare.library(tree, known))
    return summary
