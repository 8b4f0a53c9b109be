"""A pixel's part of the array's lines, against what plain metal of their length has; the table that models read."""

import json
from dataclasses import asdict

import pytest
from hypothesis import given
from hypothesis import strategies as st

from talbot.models.parameters import ParameterError, TileParameters, drawn_lines
from talbot.models.parameters.drawn import LINES
from talbot.pixels.drawn import PIXEL_PITCHES_UM
from talbot.pixels.layout.pixel import LINE
from talbot.pixels.layout.write import array_layout
from talbot.pixels.pixel_layout.lines import COLUMN_NETS, NAMES, ROWS, extracted, table
from talbot.platforms.pixel import pixel_process

pytestmark = pytest.mark.needs("layout")


@pytest.mark.slow  # three arrays a pitch, half a minute
@pytest.mark.parametrize("pitch_um", (10.0, 13.5))
def test_lines_of_the_drawn_array(pitch_um):
    array = array_layout("sky130", 8, 12, TileParameters(), 1e-6 * pitch_um)
    found, metals = extracted(array), pixel_process("sky130").metals
    assert set(found) == set(NAMES)
    for names, metal in ((ROWS, metals[1]), (COLUMN_NETS, metals[2])):
        for name in names:
            line = found[name]
            # a plain line of the pitch; what branches off it makes it a little wider
            assert 0.9 < line.ohm / (pitch_um / LINE * metal.sheet_ohm) <= 1
            alone = 1e-18 * (pitch_um * LINE * metal.area_af_um2 + 2 * pitch_um * metal.fringe_af_um)
            assert alone < line.farad["min"] < line.farad["typ"] < line.farad["max"] < 5 * alone
    first, second = (found[name].farad["typ"] for name in COLUMN_NETS)
    assert first == pytest.approx(second, rel=0.05)  # mirror images but for the gratings
    (parameters,) = table("sky130", {pitch_um: found})["parameters"]
    exact = pitch_um in json.loads(LINES.read_text())["pitches_um"]
    assert asdict(drawn_lines(pitch_um)) == pytest.approx(parameters, rel=1e-3 if exact else 0.03)


def test_the_table_that_models_read(tmp_path):
    kept, file = json.loads(LINES.read_text()), tmp_path / "lines.json"
    assert kept["command"].startswith("make pixel-layout") and tuple(kept["pitches_um"]) == PIXEL_PITCHES_UM
    for pitch, lines, parameters in zip(kept["pitches_um"], kept["lines"], kept["parameters"], strict=True):
        assert set(lines) == set(NAMES) and asdict(drawn_lines(pitch)) == parameters
        most = max(lines[name]["farad"]["typ"] for name in COLUMN_NETS)
        assert drawn_lines(pitch).column_farad == pytest.approx(most, rel=1e-3)
    with pytest.raises(ParameterError, match=r"pitch_um = 9.0: must be a number in \[10.0, 15.0\]"):
        drawn_lines(9.0)
    file.write_text(json.dumps(kept | {"parameters": [one | {"row_ohm": -1} for one in kept["parameters"]]}))
    with pytest.raises(ParameterError, match="row_ohm = -1"):
        drawn_lines(table=file)


@given(st.integers(1000, 1499))
def test_a_larger_pitch_has_more_of_every_line(steps):
    near, far = (asdict(drawn_lines(k / 100)) for k in (steps, steps + 1))
    assert all(near[name] < far[name] for name in near)
