"""Drawn columns: on the pixels' pitch, all devices, each column at its own lines, pins as the black box has them."""

from dataclasses import replace
from itertools import pairwise

import pytest

from talbot.base.gds import db
from talbot.models.parameters import ArrayParameters, ChipParameters, ParameterError
from talbot.pixels.analog_layout import flat
from talbot.pixels.analog_layout.column import column_cell
from talbot.pixels.analog_layout.column_amplifiers import EXTERNAL_PINS, NAME, SOURCE, band_nets, draw_column_amplifiers
from talbot.pixels.analog_layout.column_parts import CAPS, PIECES
from talbot.pixels.analog_layout.column_plan import GROUPED, LINE_WIDTH, column_plan, devices, length_um, names
from talbot.pixels.analog_layout.columns import column_nets, draw_columns
from talbot.pixels.blocks import AnalogSizes, blocks
from talbot.pixels.circuits.column import PINS, column
from talbot.pixels.circuits.column_block import band
from talbot.pixels.circuits.column_sizes import ColumnSpec, size
from talbot.platforms.analog import analog_masks
from talbot.platforms.sky130 import analog as process

pytestmark = pytest.mark.needs("layout")

MASKS = analog_masks("sky130")
SIZES = size(ColumnSpec.of(), process)


def sizes(circuit):
    return sorted((t.role, t.w, t.l) for t in flat.transistors(circuit))


@pytest.fixture(scope="module")
def cell():
    return column_cell(MASKS, SIZES)


@pytest.fixture(scope="module")
def block():
    return draw_column_amplifiers(MASKS, SIZES, ArrayParameters(384, 384), ChipParameters())


def test_all_devices_are_drawn_once_on_the_pixels_pitch(cell):
    assert sorted((t.role, t.w, t.l) for t in cell.transistors) == sizes(column(SIZES))
    drawn = [name for piece in PIECES for name in (*piece.n, *piece.p) if name]
    assert len(drawn) == len(set(drawn)) == len(sizes(column(SIZES)))
    assert cell.cell.dbbox().height() == pytest.approx(10.0)


def test_plates_have_the_circuits_capacitance(cell):
    farads = {c.name: (c.value, {c.a, c.b}) for c in flat.capacitors(column(SIZES))}
    assert {plate.name for plate in cell.plates} == set(farads) == {cap.name for group in CAPS for cap in group}
    for plate in cell.plates:
        value, nets = farads[plate.name]
        assert {plate.upper, plate.lower} == nets
        step = 0.005 * (2 * 8.2 + 0.38)  # fF of half a step of the grid on either side
        drawn = value - next(cap.between_lines for group in CAPS for cap in group if cap.name == plate.name)
        assert 2 * plate.area + 0.19 * plate.edge == pytest.approx(1e15 * drawn, abs=step)
    with pytest.raises(ParameterError, match="capacitor = 1e-15 F: must be 1 um long"):
        length_um(1e-15, MASKS)


def test_no_two_lines_are_nearer_than_their_rule():
    plan = column_plan(devices(SIZES), SIZES, MASKS, ("one", "two"))
    wide = {name: 0.6 if net[:4] in ("lane", "sens") else LINE_WIDTH for net in GROUPED for name in names(net)}
    ordered = sorted((x, wide.get(name, LINE_WIDTH)) for name, x in plan.lines.items())
    assert all(b - a - (one + two) / 2 >= 0.4 - 1e-6 for (a, one), (b, two) in pairwise(ordered))
    assert {"one", "two"} < set(plan.lines)


def test_each_column_has_a_via_at_one_line_of_each_group():
    layout = db.Layout()
    layout.dbu = 0.001
    made = draw_columns(layout, MASKS, SIZES, ArrayParameters(48, 60), 8)
    codes: dict[int, set[float]] = {}
    for one in made.cell.each_inst():
        if one.cell.name == "column_code":
            codes.setdefault(int(one.trans.disp.y // 10_000), set()).add(one.trans.disp.x / 1000)
    assert sorted(codes) == list(range(60)) and all(len(xs) == len(GROUPED) for xs in codes.values())
    assert len({frozenset(xs) for xs in codes.values()}) == 60
    lines = {name: round(x, 3) for name, x in made.plan.lines.items()}
    assert codes[50] == {lines[f"{net}{k}"] for net, k in {"group": 1, "k": 2}.items()} | {
        lines[f"{kind}_{d}0"] for kind in ("lane", "sense") for d in "ab"
    }
    nets = dict(zip(PINS, column_nets(50, 8), strict=True))
    assert (nets["group"], nets["k"], nets["lane_b"], nets["sense_b"]) == ("group_1", "k_2", "lane_b[0]", "lane_b[0]")
    assert (nets["ref_a"], nets["start_a"], nets["column_a"]) == ("ref", "start_a", "column_a[50]")


def test_pins_are_those_of_the_black_box_and_what_is_outside(block):
    plain = next(one for one in blocks(sizes=AnalogSizes(columns_um=block.block.height_um)) if one.name == NAME)
    own = {(pin.name, pin.side, round(pin.at_um, 3)) for pin in block.block.pins}
    wanted = {(pin.name, pin.side, round(pin.at_um, 3)) for pin in plain.pins}
    assert wanted < own and {name for name, *_ in own - wanted} == {*EXTERNAL_PINS, SOURCE}
    assert any(pin.name == "hold" for pin in plain.pins)
    assert block.count == 384 * len(sizes(column(SIZES))) + len(sizes(band(SIZES, 8)))
    nets = band_nets(block.band.cell.ports, 8)
    assert {"tap[1]", "hold", "vddc", "lane_b[7]", "ibias_columns"} < set(nets)


def test_ways_are_apart(block):
    numbers = [number for found in block.band.ways.values() for number in found]
    assert len(numbers) == len(set(numbers)) and min(numbers) > 0
    assert all(len(block.band.ways[f"lane_{d}{lane}"]) == 2 for d in "ab" for lane in range(8))


def test_what_does_not_fit_is_named():
    with pytest.raises(ParameterError, match="array.pitch_um = 9.0: must be .*10.*15"):
        draw_column_amplifiers(MASKS, SIZES, ArrayParameters(8, 384, pitch=9e-6), ChipParameters())
    with pytest.raises(ParameterError, match="column strip 0 = .* tracks: must be 13 at most"):
        column_cell(MASKS, replace(SIZES, front=replace(SIZES.front, top=4.0)))
    with pytest.raises(ParameterError, match="array.cols = 384: must be at most 192, the lines of 4 lanes"):
        draw_column_amplifiers(MASKS, SIZES, ArrayParameters(8, 384), replace(ChipParameters(), lanes=4))
    with pytest.raises(ParameterError, match="chip.lanes = 16: must be .*1..8"):
        draw_column_amplifiers(MASKS, SIZES, ArrayParameters(8, 384), replace(ChipParameters(), lanes=16))
