"""A foundry's deck over drawn pixels: a small one with a rule that these keep, and one that they break."""

import pytest

from talbot.base.gds import db, read_gds, write_gds
from talbot.pixels.layout.array import draw_pixels, draw_tile
from talbot.pixels.layout.write import array_layout
from talbot.pixels.pixel_layout import foundry

pytestmark = pytest.mark.needs("layout", "klayout")

DECK = """
source($input, $topcell)
report("two rules", $report)
input(71, 20).width(0.3.um).output("m4.1", "met4 width") if $beol == "true"
input(65, 44).width(LIMIT.um).output("tap.1", "a tap's width") if $feol == "true"
"""


@pytest.mark.parametrize("limit, broken", [(0.35, False), (0.37, True)])
def test_violations_by_file_and_rule(limit, broken, tmp_path):
    array, layout = array_layout("sky130", 4, 6), db.Layout()
    layout.dbu = 0.001
    cells = draw_pixels(layout, array)
    for name in foundry.CHECKED:
        write_gds(layout, tmp_path / name, draw_tile(layout, array, cells) if name == "tile.gds" else cells[0])
    deck = tmp_path / "deck.drc"
    deck.write_text(DECK.replace("LIMIT", str(limit)))
    found = foundry.check(array, "sky130", tmp_path, {"klayout": deck})
    assert found["klayout"].keys() == set(foundry.CHECKED)
    # two sides of each of a pixel's taps, of the substrate and of two wells; the substrate's is at the cell's edge
    per_pixel = found["klayout"]["pixel.gds"].get("tap.1", 0)
    assert (per_pixel > 0) == broken and set(found["klayout"]["pixel.gds"]) <= {"tap.1"}
    assert found["klayout"]["tile.gds"].get("tap.1", 0) == 24 * per_pixel
    assert foundry.total(found) == 26 * per_pixel
    assert foundry.check(array, "sky130", tmp_path, {}) == {}


def test_magic_is_given_the_types_at_multiples_of_45_degrees(tmp_path):
    array = array_layout("sky130", 4, 6)
    foundry.draw_straight(array, tmp_path / "straight.gds")
    layout = read_gds(tmp_path / "straight.gds")
    names = {instance.cell.name for instance in layout.top_cell().each_inst()}
    assert names == {pixel.name for pixel in array.pixels if pixel.kind.gamma_deg in (0, 90, 45, -45)}
    assert len(names) == 16
