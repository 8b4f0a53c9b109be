"""The extracted comparator: matched nets have the same metal, and what is cut or swapped is found."""

from dataclasses import replace

import numpy as np
import pytest

from talbot.base.gds import db
from talbot.base.steps import StepError
from talbot.pixels.analog_layout.array import ArrayPlan, draw_array, edges
from talbot.pixels.analog_layout.cells import Cell, comparator_cell, new_canvas
from talbot.pixels.analog_layout.pattern import binary
from talbot.pixels.circuits.comparator import ComparatorSizes
from talbot.pixels.circuits.lane import size
from talbot.pixels.circuits.netlist import Circuit, Instance
from talbot.pixels.circuits.specification import LaneSpec
from talbot.pixels.datasheet.linearity import inl_dnl, levels
from talbot.pixels.post_layout.extract import extract
from talbot.platforms.analog import analog_masks
from talbot.platforms.sky130 import analog
from talbot.platforms.sky130.wires import WIRES

pytestmark = pytest.mark.needs("layout")

MASKS, SIZES = analog_masks("sky130"), size(LaneSpec.of(), analog)
TYPICAL = WIRES["typ"]


@pytest.fixture(scope="module")
def cell():
    return comparator_cell(MASKS, SIZES.comparator)


def test_matched_nets_have_the_same_capacitance_and_couplings(cell):
    circuit, nets = extract(cell, MASKS, TYPICAL)
    circuit.check(analog)
    for a, b in (("inp", "inn"), ("outp", "outn"), ("arm.xp", "arm.xn"), ("set", "clear")):
        assert nets.totals[a] == pytest.approx(nets.totals[b], rel=0.02)
    assert nets.couplings["arm.xp", "inp"] == pytest.approx(nets.couplings["arm.xn", "inn"], rel=0.02)
    assert {t.name for t in circuit.transistors} == {t.name for t in cell.transistors}
    widths = {t.name: t.w for t in circuit.transistors}
    assert widths == {t.name: t.w for t in cell.transistors}


def test_a_circuit_around_an_extracted_one_has_its_fingers(cell):
    found, _ = extract(cell, MASKS, TYPICAL)
    whole = Circuit("whole", found.ports, instances=(Instance("inner", found, found.ports),))
    assert whole.sizes() == found.sizes()
    assert [line for line in whole.lines(analog) if " m=20 " in line]
    assert found.lines(analog) == whole.lines(analog)[: len(found.lines(analog))]


def test_capacitance_is_kept_with_and_without_resistance(cell):
    sums = []
    for resistance in (True, False):
        circuit, nets = extract(cell, MASKS, TYPICAL, resistance)
        sums.append(sum(c.value for c in circuit.capacitors))
        whole = sum(farad for net, farad in nets.grounds.items() if net != "vss") + sum(nets.couplings.values())
        assert sums[-1] == pytest.approx(whole, rel=1e-3)
        assert bool(circuit.resistors) == resistance
        pins = {node for t in circuit.transistors for node in t.nodes}
        assert {"inp", "outp", "arm.xp"} <= {node.split("__")[0] for node in pins}


def test_a_net_in_pieces_is_named(cell):
    broken = db.Layout()
    broken.assign(cell.layout)
    top = broken.top_cell()
    metal = broken.layer(*MASKS.base.metals[4].gds)
    whole = db.Region(top.shapes(metal))
    top.clear(metal)
    axis = top.dbbox().center().x / broken.dbu
    west = [one for one in whole.each() if 0 < axis - one.bbox().center().x < 5000]
    top.shapes(metal).insert(whole - db.Region(west))
    with pytest.raises(StepError, match=r"net out[pn] must be one piece"):
        extract(replace(cell, layout=broken, cell=top), MASKS, TYPICAL)


def test_what_couples_to_the_common_node_grows_with_the_bits():
    nets = {f"bit{k}": f"b{k}" for k in range(8)} | {"terminator": "bt", "half": "bh"}
    plan = ArrayPlan(binary(), nets, "top", *edges(SIZES.dac, MASKS), 0, 80)
    canvas = new_canvas(MASKS, "array")
    array = draw_array(canvas, MASKS, plan, 2.0)
    for track in array.tracks:
        canvas.label(3, track.net, track.left + 0.3, track.y)
    canvas.label(4, "top", array.exit[0], array.exit[1] - 0.3)
    ports = ("top", *plan.buses())
    made = Cell(canvas.layout, canvas.cell, ports, (), tuple(plan.plates()), (), tuple(array.taps))
    circuit, found = extract(made, MASKS, TYPICAL)
    coupled = np.array([found.couplings[net, "top"] for net in (*(f"b{k}" for k in range(8)), "bt", "bh")])
    weights = np.array([*(1 << k for k in range(8)), 1, 0.5])
    assert max(inl_dnl(levels(weights + coupled / SIZES.dac.unit))) < 0.15  # LSB
    units = sum(c.value for c in circuit.capacitors if c.name.startswith("p"))
    assert units == pytest.approx(256.5 * SIZES.dac.unit, rel=1e-3)


def test_sizes_are_of_a_comparator_that_is_drawn():
    small = comparator_cell(MASKS, ComparatorSizes(input_w=8.0, latch_n_w=4.0))
    _, nets = extract(small, MASKS, TYPICAL)
    assert nets.totals["outp"] < 60e-15
