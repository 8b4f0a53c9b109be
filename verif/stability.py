"""Stiff and extreme cases of optics, reconstruction, chip and cells: the bound of each, and what was measured.

Cases of models and chip run with NumPy's warnings raised as errors; frames go through the chip's Verilog, cells through
ngspice.
"""

import json
import warnings
from argparse import ArgumentParser, Namespace
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from talbot.base.cases import write_page
from talbot.base.files import check_file, staged
from talbot.base.paths import RESULTS
from talbot.base.progress import each
from talbot.imaging.frame import job
from talbot.imaging.frame.figures import summarize
from talbot.imaging.frame.request import request
from talbot.models.digital.divider import phase_error, quad_divide
from talbot.models.stability import Case, optical_cases, table
from talbot.models.stability_inverse import inverse_cases

Groups = Mapping[str, Callable[[], Iterable[Case]]]  # functions that measure cases, by title
STRICT: Mapping[str, Any] = {"all": "raise", "under": "ignore"}
SINGLE_TYPE = 1 << 13
# (name, arguments of `request`); few sizes, since each compiles a simulator
FRAMES = (
    ("one tile, 4 x 6", {"rows": 4, "cols": 6, "scene": "camera"}),
    ("1 x 37 pixels", {"rows": 1, "cols": 37, "scene": "camera"}),
    ("37 x 1 pixels", {"rows": 37, "cols": 1, "scene": "camera"}),
    ("37 x 50, threshold 0", {"rows": 37, "cols": 50, "threshold": 0}),
    ("37 x 50, threshold 127", {"rows": 37, "cols": 50, "threshold": 127}),
    ("37 x 50, all types masked but one", {"rows": 37, "cols": 50, "mask": SINGLE_TYPE, "threshold": 0}),
    ("37 x 50, noise 100 times physical", {"rows": 37, "cols": 50, "noise": 100.0}),
    ("37 x 50, saturated scene", {"rows": 37, "cols": 50, "scene": "saturated", "threshold": 0}),
    ("37 x 50, black scene", {"rows": 37, "cols": 50, "scene": "black"}),
    ("37 x 50, black scene, no noise", {"rows": 37, "cols": 50, "scene": "black", "noise": 0.0, "threshold": 0}),
    ("37 x 50, saturated, image mode", {"rows": 37, "cols": 50, "scene": "saturated", "mode": "image"}),
    ("37 x 50, raw mode", {"rows": 37, "cols": 50, "mode": "raw"}),
    ("37 x 50, time of flight", {"rows": 37, "cols": 50, "mode": "tof"}),
    ("37 x 50, time of flight through the divider", {"rows": 37, "cols": 50, "mode": "tof", "phase": True}),
)


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot stability`."""
    parser.add_argument("--only", nargs="+", choices=SUBJECTS, help="subjects; default: all")
    parser.add_argument("--out", type=Path, default=RESULTS / "stability", help="folder of the page")
    parser.add_argument("--json", type=Path, help="also write the table to this file")


def run(options: Namespace) -> int:
    """Print the table of all cases and write it as a page; 1 where a bound is missed."""
    if options.json:
        check_file("json", options.json)
    cases = measured(options.only or [*SUBJECTS])
    print(table(cases))
    write_page(options.out, "Stiff and extreme cases", "make stability", cases)
    if options.json:
        with staged(options.json.parent) as part:
            (part / options.json.name).write_text(
                json.dumps([vars(case) for case in cases], indent=1) + "\n", encoding="utf-8"
            )
    return 0 if all(case.ok for case in cases) else 1


def frame_cases(name: str, arguments: dict[str, Any]) -> list[Case]:
    """Simulate a frame in Verilog: no byte may differ from the golden model, and every figure is finite."""
    frame_request = request(**arguments)
    result = job.simulate_frame(frame_request)
    exposed, summary = result.exposed, summarize(result)
    wrong = summary["stream_mismatches"] + summary["decoded_mismatches"]
    finite = bool(np.isfinite(exposed.samples).all() and np.isfinite(exposed.ideal).all())
    figures = f"{wrong} differ, {len(result.chip.stream)} bytes"
    return [Case(name, "0 bytes or samples differ", figures, wrong == 0 and finite)]


def divider_cases() -> list[Case]:
    """Return the divider where it is stiff: equal operands, zeros, full scale, every sign."""
    full = np.array([-256, -255, 255])
    corners = [np.ravel(a) for a in np.meshgrid(full, full)]
    equal = np.arange(-255, 256)
    equal = equal[equal != 0]
    small = np.arange(1, 256)
    sets = {
        "|x| = |y|, every sign": (np.r_[equal, equal], np.r_[equal, -equal]),
        "full scale, every sign": corners,
        "one operand zero, every sign": (np.r_[equal, 0 * equal], np.r_[0 * equal, equal]),
        "ratio just under one and just over zero": (np.r_[small, 0 * small + 255], np.r_[small - 1, small]),
    }
    out = []
    for name, (x, y) in sets.items():
        worst = float(np.abs(phase_error(quad_divide(x, y).phase, x, y)).max())
        out.append(Case(f"divider: {name}", "phase within 0.75 LSB of atan2", f"{worst:.3f} LSB", worst <= 0.75))
    zero = quad_divide(np.array([0]), np.array([0]))
    right = bool(zero.zero[0]) and not (zero.ratio[0] or zero.octant[0] or zero.phase[0] or zero.amp_valid[0])
    outputs = "they are" if right else "they are not"
    return [*out, Case("divider: x = y = 0", "zero flag, every other output 0", outputs, right)]


def _cells() -> Groups:
    from talbot.cells import stability  # needs the PDK's packages

    return stability.groups()


SUBJECTS: Mapping[str, Callable[[], Groups]] = {
    "optics": lambda: {"optics": optical_cases},
    "inverse": lambda: {"inverse": inverse_cases},
    "divider": lambda: {"divider": divider_cases},
    "frames": lambda: {name: partial(frame_cases, name, arguments) for name, arguments in FRAMES},
    "cells": _cells,
}


def measured(subjects: Iterable[str]) -> list[Case]:
    """Measure the cases of ``subjects``: minutes when the simulators are not cached; shows progress."""
    groups = [(subject, *group) for subject in subjects for group in SUBJECTS[subject]().items()]
    cases = []
    for subject, _, measure in each(groups, "cases", lambda group: group[1]):
        with warnings.catch_warnings(), np.errstate(**({} if subject == "cells" else STRICT)):
            if subject != "cells":
                warnings.simplefilter("error")
            cases += measure()
    return cases
