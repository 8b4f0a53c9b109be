"""Two descriptions of a cell: what belongs together is found, what is alone is named."""

import numpy as np
import pytest

from talbot.base.liberty.group import Group
from talbot.cells.liberty import reference
from talbot.cells.liberty.compare import Difference, differences, errors, summary
from talbot.cells.liberty.reference import files
from talbot.models.parameters import ParameterError

AXES = {"index_1": [0.01, 1.0], "index_2": [0.001, 0.1]}


def cell(*timings, leakage=(), pin="Q"):
    """A cell with leakage (when, nW) and an output ``pin`` with timings (attributes, {table: value everywhere})."""
    group = Group("cell", ("c",), {"cell_leakage_power": 1.0})
    for when, value in leakage:
        group.add("leakage_power", when=when, value=value)
    output = group.add("pin", pin, direction="output")
    for attributes, tables in timings:
        timing = output.add("timing", **attributes)
        for kind, value in tables.items():
            timing.add(kind, "t", **AXES, values=np.full((2, 2), float(value)))
    return group


def clear(sense, **tables):
    return {"related_pin": "R", "timing_type": "clear", "timing_sense": sense}, tables


def found(ours, theirs):
    return {
        d.what: (float(np.mean(d.ours)), float(np.mean(d.theirs)))
        for d in differences("c", ours, theirs)
        if d.kind != "leakage"
    }


def test_the_same_sense_goes_first():
    """Both senses of an arc, in another order: a mux's select."""
    both = [
        ({"related_pin": "S", "timing_sense": sense}, {"cell_rise": value})
        for sense, value in (("positive_unate", 1), ("negative_unate", 2))
    ]
    assert found(cell(*both), cell(*reversed(both))) == {
        "Q S negative_unate cell_rise": (2, 2),
        "Q S positive_unate cell_rise": (1, 1),
    }


def test_a_release_is_paired_across_types():
    """Theirs has a latch's release among 'clear', ours as 'preset', as Liberty names an output that rises."""
    ours = cell(
        clear("positive_unate", cell_fall=1),
        ({"related_pin": "R", "timing_type": "preset", "timing_sense": "positive_unate"}, {"cell_rise": 3}),
    )
    theirs = cell(clear("positive_unate", cell_fall=1, cell_rise=4))
    assert found(ours, theirs)["Q R clear positive_unate cell_rise"] == (3, 4)
    assert summary(differences("c", ours, theirs))["only_ours"] == []


def test_states_of_theirs_are_each_held_against_our_one_table():
    theirs = cell(
        *(
            ({"related_pin": "A", "timing_sense": "positive_unate", "when": when}, {"cell_rise": value})
            for when, value in (("B", 2), ("!B", 4))
        )
    )
    ours = cell(({"related_pin": "A", "timing_sense": "positive_unate"}, {"cell_rise": 4}))
    assert found(ours, theirs) == {"Q A positive_unate B cell_rise": (4, 2), "Q A positive_unate !B cell_rise": (4, 4)}


def test_what_is_alone_is_named_and_not_dropped():
    ours, theirs = cell(clear("positive_unate", cell_fall=1)), cell(clear("positive_unate", fall_transition=1))
    report = summary(differences("c", ours, theirs))
    assert report["only_theirs"] == ["c: Q R clear positive_unate fall_transition"]
    assert report["only_ours"] == ["c: Q R clear positive_unate cell_fall"]
    assert report["error"]["slew"]["missing"] == 4 and "delay" not in report["error"]
    other = summary(differences("c", cell(clear("positive_unate", cell_fall=1), pin="X"), theirs))
    assert other["only_theirs"] == ["c: Q R clear positive_unate fall_transition"]


def test_leakage_is_paired_by_what_the_conditions_mean():
    """In another order, with blanks, and with an output that ours does not name."""
    ours = cell(leakage=(("A&!B", 2.0), ("A&B", 4.0), ("!A&B", 8.0), ("!A&!B", 16.0)))
    theirs = cell(leakage=(("!B & A & !Q", 2.0), ("A", 6.0), ("!A", 12.0)))
    assert found(ours, theirs) == {"!B & A & !Q": (2.0, 2.0), "A": (3.0, 6.0), "!A": (12.0, 12.0)}
    assert summary(differences("c", ours, theirs))["error"]["leakage by state"]["worst"] == pytest.approx(50)


def test_numbers_without_axes_and_zeros_are_compared():
    """As a foundry may write when an output is let go: one number for every slew and load, and no slew."""
    attributes = {"related_pin": "E", "timing_type": "three_state_disable", "timing_sense": "positive_unate"}
    ours = cell((attributes, {"cell_rise": 3, "rise_transition": 0}))
    theirs = cell((attributes, {"rise_transition": 0}))
    theirs.one("pin", "Q").one("timing").add("cell_rise", "scalar", values=[2.0])
    error = summary(differences("c", ours, theirs))["error"]
    assert error["delay"]["worst"] == pytest.approx(50) and error["slew"] == {
        "unit": "%",
        "entries": 4,
        "missing": 0,
        "median": 0.0,
        "p95": 0.0,
        "worst": 0.0,
    }


def test_a_reference_is_taken_at_its_corner(tmp_path):
    """SkyWater's library folders hold every corner of every cell."""
    for name in ("inv_1__tt_025C_1v80", "inv_1__ss_100C_1v60", "nand2_1__ff_n40C_1v95_ccsnoise"):
        (tmp_path / name[:3]).mkdir(exist_ok=True)
        (tmp_path / name[:3] / f"sky130_fd_sc_hd__{name}.lib.json").write_text("{}")
    assert files(tmp_path, "ss_100C_1v60")["inv_1"].name.endswith("ss_100C_1v60.lib.json")
    assert list(files(tmp_path, "ff_n40C_1v95")) == ["nand2_1"]
    with pytest.raises(ParameterError, match="of sf_025C_1v80"):
        files(tmp_path, "sf_025C_1v80")


@pytest.mark.parametrize("text", ["", "[]", "[" * 100_000])
def test_a_reference_that_is_no_cell_is_refused(text, tmp_path):
    (tmp_path / "inv_1.lib.json").write_text(text)
    with pytest.raises(ParameterError, match="inv_1.lib.json: is not a cell in SkyWater's JSON"):
        reference.cell(tmp_path / "inv_1.lib.json")


def test_constraints_that_are_too_short_are_told_from_long_ones():
    setup = Difference("c", "setup", "D", np.array([0.1, 0.3]), np.array([0.13, 0.2]))
    assert errors([setup])["setup"] == {
        "unit": "ps", "entries": 2, "missing": 0, "median": 65, "p95": 96.5, "worst": 100, "optimistic": 30
    }  # fmt: skip
