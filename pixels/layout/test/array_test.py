"""The array: a type at each place of the tile, dummies around it, pins where the black box has them."""

from dataclasses import replace

import klayout.db as db
import pytest

from talbot.base.lef.read import read_macro
from talbot.models.parameters import ArrayParameters, ParameterError
from talbot.pixels.blocks import SUPPLIES, AnalogSizes, pixel_array
from talbot.pixels.footprints import lef
from talbot.pixels.layout.array import DUMMIES, SOUTH, WEST, draw_array, draw_pixels, inside
from talbot.pixels.layout.write import NAME, array_layout, array_lef, write

pytestmark = pytest.mark.needs("layout")
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


def test_the_sensors_array_abuts_as_its_black_box():
    """Of 384 x 384 pixels: rows and columns where the footprint has them, all moved by one distance a side."""
    array = ArrayParameters()
    macro = read_macro(array_lef(array_layout("sky130", array.rows, array.cols)))
    black_box = read_macro(lef(pixel_array(array), "sky130", AnalogSizes().supply_um))
    assert macro.pins.keys() == black_box.pins.keys() and len(macro.pins) == 384 * 6 + 384 * 2 + 2
    moved = {}
    for name, pin in macro.pins.items():
        (layer, at), (wanted, was) = pin.boxes[0], black_box.pins[name].boxes[0]
        assert (layer, pin.direction) == (wanted, black_box.pins[name].direction)
        if name not in SUPPLIES:
            moved.setdefault(name.partition("_")[0] == "column", set()).add(
                tuple(round(a - b, 3) for a, b in zip(at, was, strict=True))
            )
    assert moved == {True: {(WEST + 20, 0.0, WEST + 20, 0.0)}, False: {(0.0, SOUTH + 20, 0.0, SOUTH + 20)}}


def test_files_are_written_together(made, tmp_path):
    write(tmp_path / "out", made)
    assert {path.name for path in (tmp_path / "out").iterdir()} == {f"{NAME}.lef", f"{NAME}.gds"}
    assert read_macro((tmp_path / "out" / f"{NAME}.lef").read_text()).width_um == made.block.width_um


def test_pixels_of_another_pitch_are_refused(made):
    with pytest.raises(ParameterError, match="pitch = 1.2e-05: must be that of every pixel"):
        replace(made, array=ArrayParameters(ROWS, COLS, pitch=12e-6))


def test_a_shuttles_fill_is_kept_out(made, drawn):
    """Metal of met1 to met5, poly and diffusion over a diode would be a shade; the blocks cover all pixels."""
    layout, cell = drawn
    pixels = db.Region(db.DBox(*inside(made)).to_itype(layout.dbu))
    for mask in ((22, 24), (33, 24), (62, 24), (105, 52), (107, 24), (112, 4), (117, 4)):
        assert (pixels - db.Region(cell.begin_shapes_rec(layout.layer(*mask)))).is_empty()
