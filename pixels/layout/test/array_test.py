"""The array: a type at each place of the tile, dummies around it, pins where the black box has them."""

from dataclasses import replace

import pytest

from talbot.base.lef.read import read_macro
from talbot.models.parameters import ArrayParameters, ParameterError
from talbot.pixels.blocks import pixel_array
from talbot.pixels.layout.array import DUMMIES, SOUTH, WEST, draw_array, draw_pixels
from talbot.pixels.layout.write import NAME, array_layout, array_lef, write

db = pytest.importorskip("klayout.db", reason="klayout: not installed; make layout installs it")
ROWS, COLS = 6, 8


@pytest.fixture(scope="module")
def made():
    return array_layout("sky130", ROWS, COLS)


@pytest.fixture(scope="module")
def drawn(made):
    layout = db.Layout()
    layout.dbu = 0.001
    return layout, draw_array(layout, made, draw_pixels(layout, made))


def test_every_place_has_its_type(made, drawn):
    _, cell = drawn
    found = {}
    for one in cell.each_inst():
        for i in range(max(1, one.na)):
            for k in range(max(1, one.nb)):
                at = one.trans.disp + one.a * i + one.b * k
                if one.cell.name.startswith("pixel"):
                    found[at.x, at.y] = one.cell.name
    assert len(found) == (ROWS + 2 * DUMMIES) * (COLS + 2 * DUMMIES)
    types = made.tile.type_map(ROWS, COLS)
    for row in range(ROWS):
        for col in range(COLS):
            x, y = 1000 * (WEST + (col + DUMMIES) * 10), 1000 * (SOUTH + (ROWS - 1 - row + DUMMIES) * 10)
            assert found[round(x), round(y)] == made.pixels[types[row, col]].name


def test_pins_are_those_of_the_black_box_and_have_their_metal(made, drawn):
    layout, cell = drawn
    pins = read_macro(array_lef(made)).pins
    assert set(pins) == {pin.name for pin in pixel_array(ArrayParameters(ROWS, COLS)).pins}
    by_name = {metal.lef: metal.gds for metal in made.pixels[0].process.metals}
    for pin in pins.values():
        for name, corners in pin.boxes:
            shapes = db.Region(cell.begin_shapes_rec(layout.layer(*by_name[name])))
            box = db.Region(db.DBox(*corners).to_itype(layout.dbu))
            assert (box - shapes).is_empty()


def test_files_are_written_together(made, tmp_path):
    write(tmp_path / "out", made)
    assert {path.name for path in (tmp_path / "out").iterdir()} == {f"{NAME}.lef", f"{NAME}.gds"}
    assert read_macro((tmp_path / "out" / f"{NAME}.lef").read_text()).width_um == made.block.width_um


def test_pixels_of_another_pitch_are_refused(made):
    with pytest.raises(ParameterError, match="pitch = 1.2e-05: must be that of every pixel"):
        replace(made, array=ArrayParameters(ROWS, COLS, pitch=12e-6))
