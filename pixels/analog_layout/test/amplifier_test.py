"""Banks in common centroid with the circuit's units; rows whose sides have one middle; all transistors are there."""

from collections import Counter

import numpy as np
import pytest

from talbot.base.gds import db
from talbot.models.parameters import ParameterError
from talbot.pixels.analog_layout import flat
from talbot.pixels.analog_layout.amplifier import amplifier_plan, bank_nets, devices, matched_units
from talbot.pixels.analog_layout.amplifier_bank import (
    COLUMNS,
    FINGERS,
    MIRRORED,
    BankPlan,
    draw_bank,
    parts,
    pattern,
    units,
)
from talbot.pixels.analog_layout.bias import bias_cell, resistor_um
from talbot.pixels.analog_layout.cells import new_canvas
from talbot.pixels.circuits.amplifier import AmplifierSpec, amplifier, size
from talbot.pixels.circuits.support import BARS, BIAS_OHM, bias
from talbot.platforms.analog import analog_masks
from talbot.platforms.sky130 import analog

pytestmark = pytest.mark.needs("layout")

MASKS = analog_masks("sky130")
SIZES = size(AmplifierSpec(), 4.7e-12, analog)
CIRCUIT = amplifier(SIZES)


def test_every_comb_has_its_partner_on_the_other_side_of_the_middle():
    names = pattern()
    assert {len(row) for row in names} == {COLUMNS}
    other = MIRRORED | {b: a for a, b in MIRRORED.items()}
    for row, turned in zip(names, names[::-1], strict=True):
        assert list(row) == [other.get(name, name) for name in turned[::-1]]
    places = {
        name: np.mean([(r, c) for r, row in enumerate(names) for c, one in enumerate(row) if one == name], axis=0)
        for name in ("b9", "b8", "b7", "b6", "b5", "b4")
    }
    middle = ((len(names) - 1) / 2, (COLUMNS - 1) / 2)
    assert all(tuple(place) == middle for place in places.values())
    assert all(sum(count for _, count in parts(comb)) == FINGERS for row in names for comb in row)


def test_banks_have_the_circuits_units_and_both_inputs_as_many():
    found = matched_units()
    for one in CIRCUIT.capacitors:
        key = min(one.a, one.b), max(one.a, one.b)
        if one.b != "vref":  # what evens out has the rest of both banks, some units more
            assert found[key] == one.units, one.name
    assert sum(n for pair, n in found.items() if "xm" in pair) == sum(units().values())
    assert sum(n for pair, n in found.items() if "xp" in pair) == sum(units().values())
    own = {side: sum(c.units for c in CIRCUIT.capacitors if (c.a, c.b) == (side, "vref")) for side in ("xm", "xp")}
    assert {side: found["vref", side] - count for side, count in own.items()} == {"xm": 11, "xp": 12}


def test_both_banks_are_drawn_alike():
    ends = dict.fromkeys([*bank_nets("m").values(), *bank_nets("p").values()], 1.0)
    drawn = []
    for side in "mp":
        canvas = new_canvas(MASKS, side)
        plan = BankPlan(2.0, bank_nets(side), f"x{side}", ends, 3.0)
        draw_bank(canvas, plan, MASKS.fringe, 0.0, side == "m")
        height = round(plan.height_um * 1000)
        turn = db.Trans() if side == "m" else db.Trans(db.Trans.M0, 0, height)
        shapes = [canvas.cell.shapes(canvas.layout.layer(*MASKS.base.metals[level].gds)) for level in (1, 2, 3)]
        drawn.append([db.Region(one).merged().transformed(turn) for one in shapes])
    assert all((a ^ b).is_empty() and not a.is_empty() for a, b in zip(*drawn, strict=True))


def test_sides_have_one_middle_in_each_strip_and_rows_end_with_dummies():
    d = devices(SIZES)
    plan = amplifier_plan(d, MASKS, SIZES)
    for strip in (plan.strips[0], plan.strips[2]):
        middles = {}
        for side in "pn":
            xs = [
                one.x + one.device.width_um / 2
                for one in strip.p
                if one.device.transistor.name.startswith(f"ota.in{side}")
            ]
            assert len(xs) == 4
            middles[side] = np.mean(xs)
        assert middles["p"] == pytest.approx(middles["n"], abs=0.01)
        for row in (strip.n, strip.p):
            for end in (row[0], row[-1]):
                assert len(set(end.device.transistor.nodes)) == 1  # off, on its rail


def test_all_transistors_of_the_circuit_are_drawn_with_their_sizes():
    d = devices(SIZES)
    plan = amplifier_plan(d, MASKS, SIZES)
    placed = Counter(one.device.transistor.name for strip in (*plan.strips, *plan.trim) for one in (*strip.n, *strip.p))
    assert set(placed.values()) == {1} and placed.keys() == d.keys()
    for t in flat.transistors(CIRCUIT):
        assert d[t.name].transistor == t


@pytest.mark.parametrize("load", [2e-12, 4e-12])
def test_amplifiers_of_other_loads_are_drawn_too_and_one_that_is_too_long_is_named(load):
    sizes = size(AmplifierSpec(), load, analog)
    plan = amplifier_plan(devices(sizes), MASKS, sizes)
    assert sum(len(strip.p) for strip in plan.strips) > 40
    large = size(AmplifierSpec(), 8e-12, analog)
    with pytest.raises(ParameterError, match="row of pair0_west = 1"):
        amplifier_plan(devices(large), MASKS, large)


def test_a_finger_has_a_unit_and_a_senseless_unit_is_refused():
    length = MASKS.finger_um(SIZES.unit)
    assert length * MASKS.fringe_um + MASKS.fringe_end == pytest.approx(SIZES.unit * 1e15, rel=0.002)
    with pytest.raises(ParameterError, match="unit = "):
        MASKS.finger_um(1e-16)


@pytest.mark.parametrize("outputs", [1, 3])
def test_a_bias_has_its_resistor_and_an_output_for_each_lane(outputs):
    made = bias_cell(MASKS, outputs)
    assert made.ports == bias(outputs).ports and len(made.ports) == outputs + 2
    assert resistor_um(BIAS_OHM / BARS, MASKS) == pytest.approx(95.83, abs=0.01)
    body = db.Region(made.cell.shapes(made.layout.layer(*MASKS.resistor)))
    assert body.area() * 1e-6 == pytest.approx(BARS * 95.835)
    names = {device.transistor.name for device in made.devices}
    assert {t.name for t in flat.transistors(bias(outputs))} <= names
