"""Drawn comparators keep the rules and are their circuit; faults planted in them are found."""

import pytest

from talbot.base.gds import db, read_gds, write_gds
from talbot.base.lef.read import read_macro
from talbot.models.parameters import ChipParameters, ParameterError
from talbot.pixels.analog_layout.cells import comparator_cell
from talbot.pixels.analog_layout.converters import draw_converters
from talbot.pixels.analog_layout.lane import lane_cell
from talbot.pixels.blocks import AnalogSizes, blocks
from talbot.pixels.circuits.amplifier import AmplifierSpec
from talbot.pixels.circuits.amplifier import size as amplifier_size
from talbot.pixels.circuits.comparator import ComparatorSizes
from talbot.pixels.circuits.lane import size
from talbot.pixels.circuits.specification import LaneSpec
from talbot.pixels.footprints import lef
from talbot.pixels.post_layout.checks import decks, differences, drc, lvs
from talbot.pixels.post_layout.test.planted import changed, swapped
from talbot.platforms.analog import analog_masks
from talbot.platforms.sky130 import analog
from talbot.platforms.sky130.layout import PLATFORM
from talbot.platforms.sky130.models import wheel
from talbot.signoff.black_box import extra_pins

pytestmark = pytest.mark.needs("layout", "klayout")

SMALL = ComparatorSizes(input_w=8.0, latch_n_w=4.0)
MASKS = analog_masks("sky130")
LANE = size(LaneSpec.of(), analog)
AMPLIFIER = amplifier_size(AmplifierSpec(), 4.7e-12, analog)


@pytest.fixture(scope="module")
def cell(tmp_path_factory):
    path = tmp_path_factory.mktemp("cell") / "comparator.gds"
    made = comparator_cell(MASKS, SMALL)
    made.write(path)
    return made, path


def test_the_comparator_keeps_the_rules_and_a_broken_one_is_found(cell, tmp_path):
    _, path = cell
    assert drc(path, "sky130", tmp_path / "good.lyrdb") == {}

    def faults(layout, top):
        metal = layout.layer(*MASKS.base.metals[3].gds)
        top.shapes(metal).insert(db.DBox(0, 0, 0.1, 5))
        low = layout.layer(*MASKS.low_threshold)
        kept = db.Region(top.shapes(low)).sized(-150)
        top.clear(low)
        top.shapes(low).insert(kept)

    found = drc(changed(path, tmp_path / "bad.gds", faults), "sky130", tmp_path / "bad.lyrdb")
    assert {"m3 width", "lvtn.4b"} <= set(found)


def test_the_comparator_is_its_circuit_and_faults_are_found(cell, tmp_path):
    made, path = cell
    assert lvs(path, made.spice(MASKS), "sky130", tmp_path / "good.lvsdb")
    assert not lvs(path, swapped(made.spice(MASKS), "inp", "inn"), "sky130", tmp_path / "swapped.lvsdb")
    found = [f"comparator: device arm.{name}" for name in ("inn", "inp")]
    assert sorted(differences(tmp_path / "swapped.lvsdb")) == found
    fewer = made.spice(MASKS).replace("W=8U", "W=6U")
    assert not lvs(path, fewer, "sky130", tmp_path / "finger.lvsdb")

    def cut(layout, top):
        """A finger's contact to the drain's strap is gone."""
        mcon = layout.layer(*MASKS.base.vias[0].gds)
        gates = db.Region(top.shapes(layout.layer(*MASKS.low_threshold)))
        vias = db.Region(top.shapes(mcon))
        lost = next(vias.inside(gates).each())
        top.clear(mcon)
        top.shapes(mcon).insert(vias - db.Region(lost))

    assert not lvs(changed(path, tmp_path / "cut.gds", cut), made.spice(MASKS), "sky130", tmp_path / "cut.lvsdb")


def test_the_rules_left_out_are_broken_by_skywaters_own_transistors():
    assert all(f'output("{rule}")' not in decks("sky130")[0] for rule in PLATFORM.contradicted)
    for kind, implant in (("nfet", MASKS.base.nplus), ("pfet", MASKS.base.pplus)):
        path = next(iter(sorted(wheel().glob(f"sky130_fd_pr/cells/rf_{kind}_01v8_lvt/*.gds"))))
        layout = read_gds(path)
        top = layout.top_cells()[0]
        masks = (db.Region(top.begin_shapes_rec(layout.layer(*mask))) for mask in (implant, MASKS.low_threshold))
        poly = db.Region(top.begin_shapes_rec(layout.layer(*MASKS.base.poly)))
        both = next(masks) & next(masks)
        assert not (both & poly).is_empty()


@pytest.fixture(scope="module")
def lane(tmp_path_factory):
    path = tmp_path_factory.mktemp("lane") / "lane.gds"
    made = lane_cell(MASKS, size(LaneSpec.of(), analog))
    made.write(path)
    return made, path


def test_the_lane_keeps_the_rules_and_is_its_circuit(lane, tmp_path):
    made, path = lane
    assert drc(path, "sky130", tmp_path / "good.lyrdb") == {}
    assert lvs(path, made.spice(MASKS), "sky130", tmp_path / "good.lvsdb")


def test_a_capacitor_that_is_missing_or_too_near_is_found(lane, tmp_path):
    made, path = lane

    def missing(layout, top):
        plates = db.Region(top.shapes(layout.layer(*MASKS.mim)))
        lost = max(
            plates.each(), key=lambda one: -abs(one.bbox().center().y - 90000) - abs(one.bbox().center().x - 45000)
        )
        top.clear(layout.layer(*MASKS.mim))
        top.shapes(layout.layer(*MASKS.mim)).insert(plates - db.Region(lost))

    assert not lvs(changed(path, tmp_path / "lost.gds", missing), made.spice(MASKS), "sky130", tmp_path / "lost.lvsdb")

    def near(layout, top):
        plates = db.Region(top.shapes(layout.layer(*MASKS.mim)))
        box = next(plates.each()).bbox()
        top.shapes(layout.layer(*MASKS.mim)).insert(db.Box(box.left, box.top + 500, box.right, box.top + 1600))

    found = drc(changed(path, tmp_path / "near.gds", near), "sky130", tmp_path / "near.lyrdb")
    assert {"capm space", "capm.8"} <= set(found) or {"capm space", "capm.3"} <= set(found)


@pytest.mark.slow
def test_lanes_with_amplifiers_and_bias_keep_the_rules_are_their_circuits_and_swapped_nets_are_found(tmp_path):
    made = draw_converters(MASKS, LANE, AMPLIFIER, ChipParameters(2), AnalogSizes())
    path = tmp_path / "adc_lanes.gds"
    write_gds(made.layout, path, made.cell)
    assert drc(path, "sky130", tmp_path / "good.lyrdb") == {}
    text = made.spice(MASKS)
    assert lvs(path, text, "sky130", tmp_path / "good.lvsdb")
    planted = (
        ("dac[3]", "dac[2]", "adc_lane"),
        ("out_0", "vref", "adc_lane"),
        ("reset_0", "reset_1", "adc_amplifier"),
        ("lane_a[0]", "lane_b[0]", "adc_amplifier"),
        ("balance[0]", "balance[1]", "adc_amplifier"),
    )
    for one, other, cell in planted:
        (line,) = (line for line in text.splitlines() if line.startswith(f"X{cell}0 "))
        wrong = line.replace(f" {one} ", " x ").replace(f" {other} ", f" {one} ").replace(" x ", f" {other} ")
        assert wrong != line
        report = tmp_path / "swapped.lvsdb"
        assert not lvs(path, text.replace(line, wrong), "sky130", report)
        assert any(one in name or f"{cell}0" in name for name in differences(report)), one


def test_the_blocks_pins_are_the_black_boxes_and_those_of_references(tmp_path):
    made = draw_converters(MASKS, LANE, AMPLIFIER, ChipParameters(), AnalogSizes())
    paths = tmp_path / "own.lef", tmp_path / "black_box.lef"
    paths[0].write_text(made.lef(MASKS))
    black_box = next(block for block in blocks() if block.name == "adc_lanes")
    paths[1].write_text(lef(black_box, "sky130", AnalogSizes().supply_um))
    assert sorted(extra_pins(*paths)) == ["refn", "refp", "vcm", "vref"]
    own, other = (read_macro(path.read_text()) for path in paths)
    assert (own.width_um, own.height_um) == (other.width_um, other.height_um)
    with pytest.raises(ParameterError, match="lanes_um = 200"):
        draw_converters(MASKS, LANE, AMPLIFIER, ChipParameters(), AnalogSizes(lanes_um=200.0))
