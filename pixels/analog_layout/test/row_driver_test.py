"""Drawn rows: on the pixels' pitch, all transistors, each row at its own lines, pins as the black box has them."""

import pytest

from talbot.base.gds import db
from talbot.models.parameters import ArrayParameters, ParameterError
from talbot.pixels.analog_layout.row_drivers import NETS, draw_row_drivers, row_cell, row_nets
from talbot.pixels.blocks import AnalogSizes, blocks
from talbot.pixels.circuits.row_driver import ROW_LINES, bank, row
from talbot.platforms.analog import analog_masks

pytestmark = pytest.mark.needs("layout")

MASKS = analog_masks("sky130")
ROWS = 12


@pytest.fixture(scope="module")
def made():
    return draw_row_drivers(MASKS, ArrayParameters(ROWS, 384))


def sizes(circuit):
    inner = (sizes(one.circuit) for one in circuit.instances)
    return sorted([*((t.role, t.w, t.l) for t in circuit.transistors), *(size for one in inner for size in one)])


def test_all_transistors_are_drawn_and_a_row_has_the_pixels_pitch(made):
    assert sorted((t.role, t.w, t.l) for t in made.row.transistors) == sizes(row())
    assert sorted((t.role, t.w, t.l) for t in made.bank.transistors) == sizes(bank())
    assert made.count == ROWS * len(sizes(row())) + len(sizes(bank()))
    assert row_cell(MASKS, ArrayParameters()).cell.dbbox().height() == pytest.approx(10.0)


def test_pins_are_those_of_the_black_box(made):
    plain = next(one for one in blocks(ArrayParameters(ROWS, 384)) if one.name == "row_driver")
    assert {pin.name: (pin.direction, pin.side) for pin in made.block.pins} == {
        pin.name: (pin.direction, pin.side) for pin in plain.pins
    }
    raised = made.block.height_um - plain.height_um
    for side, by in (("east", raised), ("west", raised), ("south", 0.0)):
        at, before = ([pin.at_um for pin in one.pins if pin.side == side] for one in (made.block, plain))
        assert at == pytest.approx([y + by for y in before])
    metal = made.layout.layer(*MASKS.base.metals[3].gds)
    drawn = db.Region(made.cell.begin_shapes_rec(metal)).merged()
    for line in ROW_LINES:
        at = next(pin.at_um for pin in made.block.pins if pin.name == f"{line}[3]")
        west = db.Region(db.DBox(198.5, at - 0.01, 199.5, at + 0.01).to_itype(0.001))
        assert not (west - drawn).count()  # its line reaches its place


def test_each_row_has_a_via_at_one_line_of_each_group(made):
    codes = [one for one in made.cell.each_inst() if one.cell.name == "row_code"]
    assert len(codes) == 6 * ROWS and len({(one.trans.disp.x, one.trans.disp.y) for one in codes}) == 6 * ROWS
    by_row = {}
    for one in codes:
        number = int((made.block.height_um * 1000 - one.trans.disp.y) // 10_000)
        by_row.setdefault(number, set()).add(one.trans.disp.x)
    assert sorted(by_row) == list(range(ROWS)) and len({frozenset(x) for x in by_row.values()}) == ROWS
    nets = [row_nets(number, ROWS) for number in range(ROWS)]
    assert nets[9][:3] == ("amp_high0", "amp_mid1", "amp_low1") and set(NETS.values()) <= set(nets[0])


def test_what_does_not_fit_is_named():
    with pytest.raises(ParameterError, match="rows = 400: must be at most 384"):
        draw_row_drivers(MASKS, ArrayParameters(400, 384))
    with pytest.raises(ParameterError, match="row_driver_um = 150: must be "):
        draw_row_drivers(MASKS, ArrayParameters(8, 384), AnalogSizes(row_driver_um=150.0))
    with pytest.raises(ParameterError, match="array.pitch_um = 9.0: must be .*10.*15"):
        draw_row_drivers(MASKS, ArrayParameters(8, 384, pitch=9e-6))
