"""Liberty text: what is written is read back."""

import numpy as np
import pytest

from talbot.base.liberty.group import Group
from talbot.base.liberty.read import is_library, is_whole, parse, without
from talbot.base.liberty.write import text
from talbot.models.parameters import ParameterError


def tree():
    lib = Group(
        "library",
        ("x",),
        {
            "time_unit": "1ns",
            "capacitive_load_unit": (1.0, "pf"),
            "nom_voltage": 1.8,
            "voltage_map": [("VPWR", 1.8), ("VGND", 0.0)],
        },
    )
    pin = lib.add("cell", "inv_1", area=3.75).add("pin", "Y", direction="output", function="!A")
    pin.add("timing", related_pin="A", timing_sense="negative_unate").add(
        "cell_rise",
        "delay",
        index_1=np.array([0.01, 1.5]),
        index_2=np.array([5e-4, 0.18]),
        values=np.array([[0.0143656, 0.6], [0.031, 1.25]]),
    )
    return lib


def test_text_is_read_back():
    back = parse(text(tree()))
    table = back.one("cell", "inv_1").one("pin", "Y").one("timing").one("cell_rise")
    assert np.array_equal(table.array("values"), [[0.0143656, 0.6], [0.031, 1.25]])
    assert back.attributes["capacitive_load_unit"] == (1.0, "pf") and back.attributes["time_unit"] == "1ns"
    assert back.one("cell", "inv_1").one("pin", "Y").attributes["function"] == "!A"


def test_comments_continuations_and_functions_with_spaces_are_read():
    group = parse('library (a) { /* c */ x : 1.5 ; cell ("b c") { f : "A & B" ; values ("1, 2", \\\n "3, 4"); } }')
    cell = group.one("cell")
    assert group.attributes["x"] == 1.5 and cell.name == "b c" and cell.attributes["f"] == "A & B"
    assert cell.attributes["values"] == [[1, 2], [3, 4]]


@pytest.mark.parametrize(
    "broken, why",
    [("library (a) { cell (b) {", "ends within"), ("library (a", "ends within"), ("library a", "must be followed by")],
)
def test_broken_text_is_refused(broken, why):
    with pytest.raises(ParameterError, match=why):
        parse(broken)


def test_without_leaves_the_other_cells_as_they_were():
    text = 'library(x) {\n cell ("a_1") { area : 1; pin(y) { function : "}"; } }\n cell (b_1) { area : 2; }\n}\n'
    assert without(text, ["a_*"]) == "library(x) {\n cell (b_1) { area : 2; }\n}\n"
    assert without(text, ["c_*"]) == text
    with pytest.raises(ParameterError, match="must end with a brace"):
        without("cell (a_1) { pin(y) {", ["a_1"])


def test_repeated_attributes_are_kept():
    back = parse(text(tree()))
    assert back.attributes["voltage_map"] == [("VPWR", 1.8), ("VGND", 0.0)]


@pytest.mark.parametrize(
    "head, known", [("/* a */ // b\nlibrary (x) {", True), ("cell (x) {", False), ("library : x", False)]
)
def test_a_library_is_known_by_how_it_begins(tmp_path, head, known):
    (tmp_path / "a.lib").write_text(head)
    assert is_library(tmp_path / "a.lib") == known


@pytest.mark.parametrize(
    "tail, whole", [("}\n", True), ("} /* end */ // of it\n", True), ("cell (y) {", False), ("} area : 2;", False)]
)
def test_a_library_is_whole_by_how_it_ends(tmp_path, tail, whole):
    (tmp_path / "a.lib").write_text(f"library (x) {{ cell (y) {{ }} {tail}")
    assert is_whole(tmp_path / "a.lib") == whole
