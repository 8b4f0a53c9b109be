"""The characterizer against a foundry's tables: one page in build/cells/report/."""

import json
from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import Any

from base.files import staged
from base.liberty.read import read
from base.page import render
from base.paths import ROOT
from cells import sources
from cells.characterize.conditions import Conditions
from cells.corner import Corner
from cells.liberty import compare, reference
from cells.library import characterize_library
from cells.report import curve, pictures, separate
from models.parameters import ParameterError

# per cent, constraints in ps: median and 95th percentile that are asked for at the typical corner
BOUNDS = {"delay": (5, 12), "slew": (5, 12), "capacitance": (5, None), "leakage": (20, None), "energy": (20, None)}
BOUNDS |= {"setup": (15, None), "hold": (15, None)}


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot cells-report`."""
    parser.add_argument("--reference", type=Path, help="folder of <cell>.lib.json; without it nothing is compared")
    parser.add_argument("--corner", default="tt_025C_1v80", help="of the reference")
    parser.add_argument("--models", default="fitted", help="set of device models of the comparison")
    parser.add_argument("--workers", type=int, default=-1, help="processes; -1: all cores")
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "cells" / "report", help="folder of the page")


def run(options: Namespace) -> int:
    """Measure, write the page and print the errors by kind."""
    conditions = Conditions(Corner.parse(options.corner), options.models)
    page = {"corner": options.corner, "default": curve.DEFAULT, "points": curve.OFF_GRID, "kinds": {}}
    if options.reference:
        page |= against(conditions, options.reference, options.out, options.workers)
    measured = curve.measure("sky130_hd", conditions, options.out / "jobs", options.workers)
    found = curve.table(measured)
    picture = pictures.error_against_time(found, curve.DEFAULT)
    page |= {"curve": found, "curve_picture": picture, "off_grid": curve.by_cell(measured)}
    with staged(options.out) as part:
        (part / "index.html").write_text(render(Path(__file__).with_name("index.html"), **page))
        figures = {name: page.get(name) for name in ("kinds", "curve", "off_grid", "variants", "alone")}
        (part / "report.json").write_text(json.dumps(figures, indent=1) + "\n")
    for kind, e in page["kinds"].items():
        errors = "median {median:7.2f} {unit}, 95th percentile {p95:7.2f}" if "median" in e else "nothing to compare"
        print(f"{kind:16} {errors.format(**e)}, {e['entries']} entries")
    print(options.out / "index.html")
    return 0


def against(conditions: Conditions, folder: Path, out: Path, workers: int) -> dict[str, Any]:
    """The page's values about the reference in ``folder``."""
    known = reference.folder(folder)
    names = sorted(set(known) & set(sources.names("sky130_hd")))
    if not names:
        raise ParameterError(f"reference = {folder}: has no cell of sky130_hd")
    characterize_library("sky130_hd", conditions, names, "extracted", out / "libraries", None, workers)
    tree = read(out / "libraries" / "sky130_hd" / f"{conditions.corner.name}.lib")
    summary = compare.summary(differences := compare.library(tree, known))
    kinds = {kind: {**e, "bound": BOUNDS.get(kind)} for kind, e in summary["error"].items()}
    groups = {name: [d for d in differences if d.cell == name] for name in names}
    cells = {name: {**compare.summary(same), "picture": pictures.heat_maps(same)} for name, same in groups.items()}
    found = separate.separate("sky130_hd", names, conditions, folder, out / "jobs", workers)
    alone = {name: summary[name] for name in ("only_theirs", "only_ours")}
    return {"kinds": kinds, "cells": cells, "variants": separate.table(found), "alone": alone}
