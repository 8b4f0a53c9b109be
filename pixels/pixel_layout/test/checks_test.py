"""The decks find what is planted in a pixel, and nothing in one as it is drawn."""

from dataclasses import replace

import pytest

from talbot.base.gds import db, write_gds
from talbot.models.parameters import ArrayParameters, TileParameters
from talbot.pixels.layout.array import DUMMIES, EAST, WEST, ArrayLayout, draw_array, draw_pixels
from talbot.pixels.layout.circuit import spice
from talbot.pixels.layout.pixel import PixelLayout, draw
from talbot.pixels.layout.write import gratings
from talbot.pixels.pixel_layout.checks import densities, drc, lvs, placed, unwaived
from talbot.platforms.pixel import pixel_process

pytestmark = pytest.mark.needs("layout", "klayout")

TYPES = TileParameters().types


def made(number, pitch_um=10.0):
    kind = TYPES[number]
    return PixelLayout(replace(gratings("sky130").geometries[kind.beta], pitch_um=pitch_um), kind, (0, 2))


def written(path, number, change=lambda layout, cell, process: None):
    """The GDS of a type's pixel once ``change`` was made to it."""
    layout = db.Layout()
    layout.dbu = 0.001
    cell = draw(layout, made(number)).cell
    change(layout, cell, pixel_process("sky130"))
    write_gds(layout, path)
    return path


def test_a_pixel_keeps_the_rules_and_faults_are_found(tmp_path):
    oblique = next(k for k, kind in enumerate(TYPES) if kind.gamma_deg == 22.5)
    found = drc(written(tmp_path / "pixel.gds", oblique), "sky130", tmp_path / "drc.lyrdb")
    assert set(found) == {"x.2"}
    assert unwaived(found) == 0

    def faults(layout, cell, process):
        cell.clear(layout.layer(*process.contact_poly))
        (hvi, _), (hvntm, _) = process.thick
        cell.clear(layout.layer(*hvntm))
        cell.shapes(layout.layer(*hvi)).insert(db.DBox(0.7, 0.75, 4.0, 2.5))  # 0.45 um from the well
        cell.shapes(layout.layer(*process.metals[4].gds)).insert(db.DBox(0.6, 5, 0.7, 9))

    found = drc(written(tmp_path / "bad.gds", oblique, faults), "sky130", tmp_path / "bad.lyrdb")
    assert {"licon.18", "hvntm.3", "hvi.5", "m4 width", "m4 space"} <= set(found)
    assert unwaived(found) == sum(found.values()) - found["x.2"] > 0


@pytest.mark.slow
@pytest.mark.parametrize("pitch_um", (12.0, 15.0))
def test_an_array_of_another_pitch_keeps_the_rules(tmp_path, pitch_um):
    layout, tile = db.Layout(), TileParameters()
    layout.dbu = 0.001
    pixels = tuple(made(number, pitch_um) for number in range(tile.n_types))
    array = ArrayLayout(ArrayParameters(tile.rows, tile.cols, 1e-6 * pitch_um), tile, pixels)
    cell = draw_array(layout, array, draw_pixels(layout, array))
    write_gds(layout, tmp_path / "array.gds", cell)
    width = (tile.cols + 2 * DUMMIES) * pitch_um + WEST + EAST
    assert layout.dbu * cell.bbox().width() == pytest.approx(width)
    assert unwaived(drc(tmp_path / "array.gds", "sky130", tmp_path / "drc.lyrdb")) == 0


def test_a_pixel_of_another_pitch_is_its_circuit(tmp_path):
    pixel, process, layout = made(0, 12.0), pixel_process("sky130"), db.Layout()
    layout.dbu = 0.001
    draw(layout, pixel)
    write_gds(layout, tmp_path / "pixel.gds")
    text = spice(pixel.name, pixel.circuit, process.deck_model, process.deck_diode)
    assert "A=42.3P" in text  # two wells of 4.7 x 9 um
    assert lvs(tmp_path / "pixel.gds", text, "sky130", tmp_path / "pixel.lvsdb")


def test_a_pixel_is_its_circuit_and_an_open_contact_is_found(tmp_path):
    pixel, process = made(0), pixel_process("sky130")
    text = spice(pixel.name, pixel.circuit, process.deck_model, process.deck_diode)
    assert lvs(written(tmp_path / "pixel.gds", 0), text, "sky130", tmp_path / "good.lvsdb")

    def opened(layout, cell, process):
        """Local metal between the diode's node and the follower's gate is gone."""
        layer = layout.layer(*process.metals[0].gds)
        rest = db.Region(cell.shapes(layer)) - db.Region(db.Box(1500, 2250, 1700, 2500))
        cell.clear(layer)
        cell.shapes(layer).insert(rest)

    assert not lvs(written(tmp_path / "open.gds", 0, opened), text, "sky130", tmp_path / "open.lvsdb")
    smaller = text.replace("A=25.9P", "A=20P", 1)
    assert not lvs(tmp_path / "pixel.gds", smaller, "sky130", tmp_path / "area.lvsdb")


def test_metal_and_places_are_read_from_the_file(tmp_path):
    layout = db.Layout()
    layout.dbu = 0.001
    process = pixel_process("sky130")
    top, cell = layout.create_cell("top"), layout.create_cell("pixel_x")
    cell.shapes(layout.layer(*process.metals[4].gds)).insert(db.DBox(0, 0, 5, 4))
    top.insert(
        db.DCellInstArray(cell.cell_index(), db.DTrans(db.DVector(10, 20)), db.DVector(10, 0), db.DVector(0, 10), 2, 3)
    )
    top.shapes(layout.layer(*process.outline)).insert(db.DBox(0, 0, 40, 50))
    write_gds(layout, tmp_path / "top.gds")
    assert densities(tmp_path / "top.gds", "sky130")["met4"] == pytest.approx(6 * 20 / 2000)
    assert placed(tmp_path / "top.gds") == {(x, y): "pixel_x" for x in (10000, 20000) for y in (20000, 30000, 40000)}
