"""The drawn rows keep the rules and are their circuit; faults planted in masks, devices and codes are found."""

import pytest

from talbot.base.gds import db, write_gds
from talbot.models.parameters import ArrayParameters
from talbot.pixels.analog_layout.row_drivers import draw_row_drivers, row_cell
from talbot.pixels.blocks import AnalogSizes, blocks
from talbot.pixels.footprints import lef
from talbot.pixels.post_layout.checks import drc, lvs
from talbot.pixels.post_layout.test.planted import changed
from talbot.platforms.analog import analog_masks
from talbot.signoff.black_box import extra_pins

pytestmark = pytest.mark.needs("layout", "klayout")

MASKS = analog_masks("sky130")
OXIDE, TIP = (mask for mask, _ in MASKS.base.thick)


@pytest.fixture(scope="module")
def row(tmp_path_factory):
    path = tmp_path_factory.mktemp("row") / "row.gds"
    made = row_cell(MASKS, ArrayParameters())
    made.write(path)
    return made, path


def test_a_row_keeps_the_rules_of_thick_oxide_and_faults_are_found(row, tmp_path):
    _, path = row
    assert drc(path, "sky130", tmp_path / "good.lyrdb") == {}

    def faults(layout, top):
        """The first transistor has no tip implant; thick oxide ends in its last diffusion; a well is too near."""
        tip, oxide = (db.Region(top.shapes(layout.layer(*mask))) for mask in (TIP, OXIDE))
        box = tip.bbox()
        top.clear(layout.layer(*TIP))
        top.shapes(layout.layer(*TIP)).insert(tip - db.Region(db.Box(box.left, box.bottom, box.left + 3000, box.top)))
        edge = oxide.bbox()
        top.clear(layout.layer(*OXIDE))
        top.shapes(layout.layer(*OXIDE)).insert(db.Box(edge.left, edge.bottom, edge.right - 5000, edge.top))

    found = drc(changed(path, tmp_path / "bad.gds", faults), "sky130", tmp_path / "bad.lyrdb")
    assert {"hvntm.3", "hvdifftap.21", "hvnwell.9"} <= set(found)


def test_a_row_is_its_circuit_and_a_shifter_of_another_size_is_found(row, tmp_path):
    made, path = row
    text = made.spice(MASKS)
    assert lvs(path, text, "sky130", tmp_path / "good.lvsdb")
    assert not lvs(path, text.replace("L=2U", "L=4U", 1), "sky130", tmp_path / "longer.lvsdb")

    def cut(layout, top):
        """The line of the reset is cut at its pin's side."""
        metal = layout.layer(*MASKS.base.metals[4].gds)
        jogs = db.Region(top.shapes(metal)) & db.Region(db.Box(162_500, 0, 170_000, 10_000))
        top.shapes(metal).insert(jogs.bbox())

    assert not lvs(changed(path, tmp_path / "short.gds", cut), text, "sky130", tmp_path / "short.lvsdb")


@pytest.mark.slow
def test_all_rows_are_their_circuit_and_a_row_with_anothers_code_is_found(tmp_path):
    made = draw_row_drivers(MASKS, ArrayParameters(12, 384))
    path, text = tmp_path / "rows.gds", made.spice(MASKS)
    write_gds(made.layout, path, made.cell)
    assert drc(path, "sky130", tmp_path / "rows.lyrdb") == {}
    assert lvs(path, text, "sky130", tmp_path / "rows.lvsdb", made.boxes)
    other = text.replace("amp_low3 ", "amp_low4 ", 1)
    assert other != text and not lvs(path, other, "sky130", tmp_path / "other.lvsdb", made.boxes)


def test_the_block_fits_its_frame(tmp_path):
    made = draw_row_drivers(MASKS, ArrayParameters(12, 384))
    plain = next(one for one in blocks(ArrayParameters(12, 384)) if one.name == "row_driver")
    paths = tmp_path / "own.lef", tmp_path / "plain.lef"
    paths[0].write_text(made.lef(MASKS))
    paths[1].write_text(lef(plain, "sky130", AnalogSizes().supply_um))
    assert extra_pins(*paths) == []
