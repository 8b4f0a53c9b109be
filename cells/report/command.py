"""The characterizer against a foundry's tables: one page in build/cells/report/."""

import json
from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import Any

from talbot.base.files import staged
from talbot.base.jobs import worker_count
from talbot.base.liberty.read import read
from talbot.base.page import render
from talbot.base.paths import RESULTS
from talbot.cells import sources
from talbot.cells.characterize.conditions import Conditions
from talbot.cells.corner import Corner
from talbot.cells.liberty import compare, reference
from talbot.cells.library import characterize_library
from talbot.cells.report import curve, pictures
from talbot.models.parameters import ParameterError

# per cent, constraints in ps: median and 95th percentile that are asked of cells that are not in the fit, at any corner
BOUNDS = {"delay": (2, 8), "slew": (2, 8), "capacitance": (5, None), "leakage": (25, None), "energy": (20, None)}
BOUNDS |= {"setup": (15, None), "hold": (15, None)}


TABLES = "curve", "off_grid"


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot cells-report`."""
    parser.add_argument("--reference", type=Path, help="folder of <cell>.lib.json; without it nothing is compared")
    parser.add_argument("--cells", help="names with commas between of cells to compare (default: all of the reference)")
    parser.add_argument("--corners", default="tt_025C_1v80", help="the corner of the reference, one")
    parser.add_argument("--models", default="fitted", help="set of device models of the comparison")
    parser.add_argument("--workers", type=worker_count, default=-1, help="processes; -1: all cores")
    parser.add_argument("--out", type=Path, default=RESULTS / "cells" / "report", help="folder of the page")


def run(options: Namespace) -> int:
    """Measure, write the page and print the errors by kind."""
    conditions = Conditions(Corner.parse(options.corners), options.models)
    page = {"corner": options.corners, "default": curve.DEFAULT, "points": curve.OFF_GRID, "tables": {}}
    if options.reference:
        page |= against(conditions, options)
    measured = curve.measure("sky130_hd", conditions, options.out / "jobs", options.workers)
    settings = curve.table(measured)
    picture = pictures.error_against_time(settings, curve.DEFAULT)
    page |= {"curve": settings, "curve_picture": picture, "off_grid": curve.by_cell(measured)}
    with staged(options.out) as part:
        (part / "index.html").write_text(html(page), encoding="utf-8")
        figures = {name: page.get(name) for name in ("tables", "curve", "off_grid", "alone")}
        (part / "report.json").write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")
    for title, kinds in page["tables"].items():
        print(f"{options.corners}, {title}")
        for kind, e in kinds.items():
            errors = (
                "median {median:7.2f} {unit}, 95th percentile {p95:7.2f}" if "median" in e else "nothing to compare"
            )
            least = ", optimistic by at most {optimistic:.1f} ps" if "optimistic" in e else ""
            print(f"{kind:16} {(errors + least).format(**e)}, {e['entries']} entries")
    print(options.out / "index.html")
    return 0


def html(page: dict[str, Any]) -> str:
    """The page; of its values the rows of tables become texts."""
    rows = {name: [list(map(_text, row)) for row in page[name]] for name in TABLES if name in page}
    rows["curve"] = [[f"{number}. {name}", *row] for number, (name, *row) in enumerate(rows["curve"], start=1)]
    template, title = Path(__file__).with_name("index.html"), f"The characterizer at {page['corner']}"
    values: dict[str, Any] = page | rows
    return render(template, title, picture=None, listed=True, **values)


def _text(value: object) -> str:
    return f"{value:.2f}" if isinstance(value, float) else str(value)


def against(conditions: Conditions, options: Namespace) -> dict[str, Any]:
    """The page's values about the reference, of the cells that are not in the fit first."""
    process, folder, out = sources.process("sky130_hd"), options.reference, options.out
    cell_names = options.cells.split(",") if options.cells else sources.names("sky130_hd")
    files = {name: file for name, file in reference.files(folder, conditions.corner.name).items() if name in cell_names}
    if not files:
        raise ParameterError(f"reference = {folder}: has no cell of {options.cells or 'sky130_hd'}")
    names = sorted(files)
    characterize_library("sky130_hd", conditions, names, "extracted", out / "libraries", None, options.workers)
    tree = read(out / "libraries" / "sky130_hd" / f"{conditions.corner.name}.lib")
    differences = compare.library(tree, {name: reference.cell(file) for name, file in files.items()})
    summary = compare.summary(differences, process.FITTED)
    titles = {"error": "cells that are not in the fit", "error_of_fit": "cells of the fit"}
    tables = {
        f"{title}: {', '.join(n for n in names if (n in process.FITTED) == (key == 'error_of_fit'))}": {
            kind: {**e, "bound": BOUNDS.get(kind)} for kind, e in summary[key].items()
        }
        for key, title in titles.items()
        if summary[key]
    }
    groups = {name: [d for d in differences if d.cell == name] for name in names}
    cells = {
        name: {"error": compare.errors(same), "picture": pictures.heat_maps(same)} for name, same in groups.items()
    }
    kinds = list(compare.errors(differences))
    alone = {name: summary[name] for name in ("only_theirs", "only_ours")}
    return {"tables": tables, "kinds": kinds, "cells": cells, "alone": alone}
