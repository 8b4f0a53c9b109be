"""Macros: what is read of their LEF, where they may be placed, and the room for the clock tree beside them."""

from dataclasses import replace

import pytest

from talbot.flow.layout.geometry.floorplan import largest_free, place_macros
from talbot.flow.layout.geometry.macro import Macro
from talbot.models.parameters import ParameterError
from talbot.platforms.coriolis import coriolis_platform

LEF = """VERSION 5.8 ;
MACRO Block
  CLASS BLOCK ;
  SIZE 40.000 BY 56.000 ;
  PIN a
    DIRECTION INPUT ;
    USE SIGNAL ;
    PORT
      LAYER met1 ;
        RECT 0.000 10.000 0.185 10.320 ;
      LAYER met1 ;
        RECT 0.000 13.000 0.300 13.320 ;
      LAYER met2 ;
        RECT 0.000 10.000 0.185 13.320 ;
    END
  END a
  PIN b[0]
    DIRECTION OUTPUT ;
    USE SIGNAL ;
    PORT
      LAYER met1 ;
        RECT 0.000 13.460 0.300 13.780 ;
    END
  END b[0]
  PIN vdd
    DIRECTION INOUT ;
    USE POWER ;
    PORT
      LAYER met4 ;
        RECT 28.400 0.000 29.600 56.000 ;
    END
  END vdd
  PIN vss
    DIRECTION INOUT ;
    USE GROUND ;
    PORT
      LAYER met4 ;
        RECT 9.400 0.000 10.600 56.000 ;
    END
  END vss
END Block
"""


@pytest.fixture
def tech():
    return replace(coriolis_platform("sky130"), row_um=5.6, site_um=0.8)


@pytest.fixture
def block(tech, tmp_path):
    (tmp_path / "block.lef").write_text(LEF)
    return Macro.read(tmp_path / "block.lef", tech)


def test_a_pin_is_met_where_it_is_farthest_from_others(block):
    assert (block.name, block.width_um, block.height_um) == ("Block", 40.0, 56.0)
    assert block.pins == {
        "a": ("input", "m1", (0.0, 10.0, 0.185, 10.32)),
        "b[0]": ("output", "m1", (0.0, 13.46, 0.3, 13.78)),
    }
    assert block.straps == (("vss", 10.0), ("vdd", 29.0))


def test_macros_are_on_rows_of_their_own_parity(block, tech):
    places = place_macros([("left", block, (0.1, 0.0)), ("right", block, (0.9, 0.6))], 240.0, 168.0, tech)
    for place in places:
        assert place["y_um"] / (2 * tech.row_um) == pytest.approx(round(place["y_um"] / (2 * tech.row_um)))
        left, bottom, right, top = place["outer"]
        assert left / tech.row_um == pytest.approx(round(left / tech.row_um))
        assert left + 16.8 == pytest.approx(place["x_um"]) and right >= place["x_um"] + 40.0 + 16.8
        assert top == pytest.approx(place["y_um"] + 56.0 + 11.2)
        assert bottom == pytest.approx(max(0, place["y_um"] - 11.2))


@pytest.mark.parametrize(
    "macros, width, words",
    [
        ([("one", (0.5, 0.0)), ("two", (0.5, 1.0))], 240.0, "one: must be 15 um west of two"),  # one above the other
        ([("one", (0.0, 0.0))], 240.0, "the west edge: must be 15 um west of one"),
        ([("one", (0.5, 0.0))], 60.0, "does not fit"),
    ],
)
def test_macros_that_do_not_fit(block, tech, macros, width, words):
    with pytest.raises(ParameterError, match=words):
        place_macros([(name, block, at) for name, at in macros], width, 168.0, tech)


def test_the_clock_tree_is_beside_the_macros():
    outer = [40.0, 0.0, 160.0, 60.0]
    assert largest_free(200.0, 160.0, [outer]) == [10.0, 60.0, 190.0, 160.0]  # north of it, cut to 1.8 times its height
    assert largest_free(200.0, 160.0, []) == [0.0, 0.0, 200.0, 160.0]
