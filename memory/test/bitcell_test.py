"""The drawn cell and the circuits below a column: spaces between neighbours, planted faults."""

import pytest

from talbot.base.gds import db, write_gds
from talbot.cells.extract.devices import find
from talbot.memory import bitcell
from talbot.memory.array import array, column_x, labelled
from talbot.memory.column_io import columns_io, draw_tile
from talbot.pixels.analog_layout import flat
from talbot.platforms.analog import analog_masks
from talbot.platforms.extraction import extraction_platform
from talbot.platforms.sky130 import analog

pytestmark = pytest.mark.needs("layout")
MASKS, PLATFORM = analog_masks("sky130"), extraction_platform("sky130")
# um of space: SkyWater's difftap.3, poly.2, li.3, m1.2, m2.2
SPACES = {"active": 0.27, "poly": 0.21, 0: 0.17, 1: 0.14, 2: 0.14}


def new_layout():
    layout = db.Layout()
    layout.dbu = 0.001
    return layout


def extracted(layout, tmp_path):
    """(kind, gate, drain and source, bulk, width, length) of every transistor of the labelled cell."""
    bit = labelled(layout, MASKS, PLATFORM.well_labels)
    write_gds(layout, tmp_path / "bit.gds", bit.cell)
    found = find(tmp_path / "bit.gds", "bit", PLATFORM)
    return sorted(
        (d.kind, d.gate, *sorted((d.drain, d.source)), d.bulk, round(d.width, 3), round(d.length, 3))
        for d in found.devices
    )


def expected():
    return sorted(
        (t.role, t.gate, *sorted((t.drain, t.source)), t.bulk, t.w, t.l) for t in bitcell.bit_cell().transistors
    )


def test_the_drawn_cell_is_its_circuit(tmp_path):
    bitcell.bit_cell().check(analog)
    assert extracted(new_layout(), tmp_path) == expected()


@pytest.mark.parametrize("mask", ["contact", "poly", "active"])
def test_a_missing_shape_is_another_circuit(mask, tmp_path):
    layout = new_layout()
    cell = bitcell.draw_cell(layout, MASKS).cell
    shapes = cell.shapes(layout.layer(*getattr(MASKS.base, mask)))
    shapes.erase(max(shapes.each(), key=lambda shape: (shape.bbox().right, shape.bbox().top)))
    assert extracted(layout, tmp_path) != expected()


@pytest.mark.parametrize("layer", SPACES)
def test_neighbours_keep_their_distance(layer):
    layout = new_layout()
    tile = draw_tile(layout, MASKS, 4, 2).cell
    mask = MASKS.base.metals[layer].gds if isinstance(layer, int) else getattr(MASKS.base, layer)
    drawn = db.Region(tile.begin_shapes_rec(layout.layer(*mask))).merged()
    assert drawn.space_check(round(1000 * SPACES[layer])).is_empty()
    assert not drawn.space_check(round(1000 * SPACES[layer]) + 500).is_empty()


def below_columns(layout, tmp_path):
    """The transistors whose nets all have names, of a tile of 8 columns."""
    write_gds(layout, tmp_path / "tile.gds", layout.cell("array"))
    found = find(tmp_path / "tile.gds", "array", PLATFORM)
    ports = set(columns_io(1).ports)
    return sorted(
        (d.kind, d.gate, *sorted((d.drain, d.source)), round(d.width, 3), round(d.length, 3))
        for d in found.devices
        if {d.drain, d.gate, d.source} <= ports
    )


def test_the_drawn_columns_are_their_circuit(tmp_path):
    layout, circuit = new_layout(), columns_io(1)
    circuit.check(analog)
    draw_tile(layout, MASKS, 2, 1)
    transistors = flat.transistors(circuit)
    assert below_columns(layout, tmp_path) == sorted(
        (t.role, t.gate, *sorted((t.drain, t.source)), t.w, t.l) for t in transistors
    )


def test_a_missing_via_is_another_column(tmp_path):
    layout = new_layout()
    draw_tile(layout, MASKS, 2, 1)
    shapes = layout.cell("array").shapes(layout.layer(*MASKS.base.vias[0].gds))
    shapes.erase(next(shapes.each()))  # of a select line
    assert len(below_columns(layout, tmp_path)) == 7 * 8 - 2


def test_an_array_has_all_cells():
    circuit = array(4, 2)
    circuit.check(analog)
    assert len(list(flat.transistors(circuit))) == 6 * 4 * 16
    steps = {round(column_x(k + 1) - column_x(k), 3) for k in range(15)}
    assert steps == {bitcell.PITCH, round(bitcell.PITCH + bitcell.STRAP, 3)}
