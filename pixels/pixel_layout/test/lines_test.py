"""A pixel's part of the array's lines, against what plain metal of their length has; the table that models read."""

import json

import pytest

from talbot.models.parameters import ParameterError, drawn_lines
from talbot.models.parameters.drawn import LINES
from talbot.pixels.layout.pixel import LINE
from talbot.pixels.pixel_layout.lines import COLUMN_NETS, NAMES, ROWS, extracted, table
from talbot.platforms.pixel import pixel_process

pytestmark = pytest.mark.needs("layout")


@pytest.mark.slow  # three arrays, half a minute
def test_lines_of_the_drawn_array():
    found, metals = extracted("sky130"), pixel_process("sky130").metals
    assert set(found) == set(NAMES)
    for names, metal in ((ROWS, metals[1]), (COLUMN_NETS, metals[2])):
        for name in names:
            line = found[name]
            # ten um of a plain line; what branches off it makes it a little wider
            assert 0.9 < line.ohm / (10 / LINE * metal.sheet_ohm) <= 1
            alone = 1e-18 * (10 * LINE * metal.area_af_um2 + 20 * metal.fringe_af_um)
            assert alone < line.farad["min"] < line.farad["typ"] < line.farad["max"] < 5 * alone
    first, second = (found[name].farad["typ"] for name in COLUMN_NETS)
    assert first == pytest.approx(second, rel=0.05)  # mirror images but for the gratings
    kept = json.loads(LINES.read_text())
    assert kept["parameters"] == pytest.approx(table("sky130", found)["parameters"], rel=1e-3)


def test_the_table_that_models_read(tmp_path):
    kept, file = json.loads(LINES.read_text()), tmp_path / "lines.json"
    assert kept["command"].startswith("make pixel-layout") and set(kept["lines"]) == set(NAMES)
    most = max(kept["lines"][name]["farad"]["typ"] for name in COLUMN_NETS)
    assert drawn_lines().column_farad == pytest.approx(most, rel=1e-3)
    file.write_text(json.dumps({"parameters": kept["parameters"] | {"row_ohm": -1}}))
    with pytest.raises(ParameterError, match="row_ohm = -1"):
        drawn_lines(file)
