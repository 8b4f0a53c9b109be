"""The tables of the drawn pixel: every value has its source, and what they say is in range and among the corners."""

import json
from dataclasses import replace

import pytest

from talbot.models.parameters import ElectricalParameters, ParameterError, drawn_electrical, drawn_lines
from talbot.models.parameters.drawn import LINES, PIXEL, drawn_sources

WRITTEN = json.loads(PIXEL.read_text())


def test_every_value_has_a_source():
    assert WRITTEN["parameters"].keys() == WRITTEN["sources"].keys()
    assert WRITTEN["command"].startswith("make pixel-circuit") and len(WRITTEN["corners"]) == 9
    assert all(source.startswith("make pixel-circuit") for source in WRITTEN["sources"].values())
    assert json.loads(LINES.read_text())["command"].startswith("make pixel-layout")


def test_the_typical_pixel_is_among_the_corners():
    found, over = drawn_electrical(ElectricalParameters()), WRITTEN["over_corners"]
    for value, name in ((found.full_well, "full_well"), (WRITTEN["parameters"]["read_noise"], "dark_noise")):
        assert over[name][0] <= value <= over[name][1]
    assert over["dark_current"][0] < found.dark_current < over["dark_current"][1]


def test_what_is_not_the_pixels_stays():
    own = ElectricalParameters(white_current=1e-10, column_fpn=3.0)
    found, came = drawn_electrical(own), drawn_sources(drawn_electrical(own))
    assert replace(found, **{name: getattr(own, name) for name in came}) == own and drawn_electrical(found) == found
    assert drawn_sources(own) == {} and came.keys() == WRITTEN["sources"].keys() | {"column_fpn", "offset_fpn"}
    assert came["full_well"] == WRITTEN["sources"]["full_well"] and "make analog" in came["read_noise"]


def test_lines_of_a_pixel():
    lines = drawn_lines()
    assert 1 < lines.row_ohm < 20 and 1 < lines.column_ohm < 20
    assert 5e-16 < lines.row_farad < lines.column_farad < 5e-15


def test_a_value_out_of_range_is_refused_by_name(tmp_path):
    file = tmp_path / "pixel.json"
    file.write_text(json.dumps({"parameters": {"full_well": 1}}))
    with pytest.raises(ParameterError, match="full_well = 1: must be"):
        drawn_electrical(ElectricalParameters(), file)
