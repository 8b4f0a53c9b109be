"""The page and its figures, from errors whose summary is known."""

import numpy as np
import pytest

from talbot.cells.liberty.compare import Difference, summary
from talbot.cells.report import command, curve, pictures

pytestmark = pytest.mark.needs("layout")

ERRORS = [
    {"name": curve.DEFAULT, "cell": "inv_1", "seconds": 2.0, "error": [1.0, -3.0, 2.0]},
    {"name": curve.DEFAULT, "cell": "nand2_1", "seconds": 3.0, "error": [-4.0, 5.0]},
    {"name": curve.DEFAULT, "cell": "dfxtp_1", "seconds": 9.0, "error": [100.0]},
    {"name": "grid 4 x 4, not refined", "cell": "inv_1", "seconds": 1.0, "error": [-8.0]},
]


def test_the_curve_has_the_settings_of_the_quick_cells():
    assert curve.table(ERRORS) == [
        (curve.DEFAULT, 5.0, 3.0, pytest.approx(4.8)),
        ("grid 4 x 4, not refined", 1.0, 8.0, 8.0),
    ]


def test_the_default_is_reported_cell_by_cell():
    assert [(cell, values, median) for cell, values, median, _ in curve.by_cell(ERRORS)] == [
        ("inv_1", 3, 2.0),
        ("nand2_1", 2, 4.5),
        ("dfxtp_1", 1, 100.0),
    ]


def test_the_default_setting_is_one_of_those_compared():
    from talbot.cells.characterize.conditions import Conditions
    from talbot.cells.corner import Corner

    base = Conditions(Corner("tt", 25, 1.8))
    assert curve.settings(base)[curve.DEFAULT] == base


def test_a_table_that_is_alone_is_named_and_has_no_map():
    full, none = np.full((2, 2), 1.0), np.full((2, 2), np.nan)
    found = [Difference("c", "delay", "Y A cell_rise", full, 2 * full), Difference("c", "slew", "Y B", none, full)]
    picture = pictures.heat_maps(found)
    assert picture.src.startswith("data:image/png;base64,") and picture.src == pictures.heat_maps(found[:1]).src
    found += [Difference("fit", "delay", "Y A cell_rise", full, full)]
    found_summary = summary(found, fitted=("fit",))
    page = {
        "corner": "tt",
        "default": curve.DEFAULT,
        "points": 1,
        "alone": found_summary,
        "tables": {
            title: {kind: {**e, "bound": (5, 12)} for kind, e in found_summary[key].items()}
            for title, key in (("held out", "error"), ("of the fit", "error_of_fit"))
        },
        "kinds": ["delay", "slew"],
        "cells": {"c": {**found_summary, "picture": picture}},
        "curve": curve.table(ERRORS),
        "off_grid": curve.by_cell(ERRORS),
        "curve_picture": pictures.error_against_time(curve.table(ERRORS), curve.DEFAULT),
    }
    html = command.html(page)
    assert "In the reference alone: c: Y B." in html and "Here alone: nothing." in html
    assert html.index("held out") < html.index("of the fit")
    assert found_summary["error"]["delay"]["median"] == 50 and found_summary["error_of_fit"]["delay"]["median"] == 0
    assert "<td>dfxtp_1</td><td>1</td>" in html and "<td>50.0</td>" in html
