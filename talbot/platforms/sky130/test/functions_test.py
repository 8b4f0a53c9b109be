"""Functions taken from the cells' Verilog against the equations that SkyWater publishes next to it."""

import itertools
import json
import re

import pytest

from talbot.platforms.sky130 import cells, functions

pytestmark = pytest.mark.needs("layout")


@pytest.fixture(scope="module")
def verilog():
    """Files of the cells' functions."""
    return [
        path
        for path in sorted((cells.folder() / "cells").glob("*/*_1.functional.v"))
        if not path.parent.name.startswith(functions.LEFT_OUT)
    ]


def value(expression, pins):
    """0 or 1 of an expression in ! & ^ | for the values ``pins`` (dict)."""
    return eval(expression.replace("!", "~"), {"__builtins__": {}}, dict(pins)) & 1


def test_every_published_equation_is_the_function_of_the_verilog(verilog):
    compared = 0
    for path in verilog:
        published = json.loads((path.parent / "definition.json").read_text()).get("equation", "")
        match = re.fullmatch(r"(\w+) = ([\w\s!&|^()]+)", published)
        made = functions.functions(path.read_text())
        if not match or match[1] not in made:
            continue
        function, pins = made[match[1]], re.findall(r"(?m)^\s*input\s+(\w+)\s*;", path.read_text())
        if not set(re.findall(r"\w+", match[2])) <= set(pins):  # a2bb2o's says A1 for the pin A1_N
            continue
        for values in itertools.product((0, 1), repeat=len(pins)):
            given = dict(zip(pins, values, strict=True))
            assert value(function, given) == value(match[2], given), (path.name, given)
        compared += 1
    assert compared > 40


def test_areas_are_whole_sites():
    for cell in ("inv_1", "dfxtp_1", "mux2_1"):
        assert cells.area(cell) / (0.46 * 2.72) == pytest.approx(round(cells.area(cell) / (0.46 * 2.72)))


def test_what_holds_a_state_has_no_function():
    text = cells.file("dfxtp_1", "functional.v").read_text()
    assert functions.functions(text) == {}
