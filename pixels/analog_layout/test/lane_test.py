"""The lane's arrays on the process's capacitors, and where its pins are."""

from dataclasses import replace

import pytest

from talbot.models.parameters import ParameterError
from talbot.pixels.analog_layout.array import edges
from talbot.pixels.analog_layout.lane import lane_cell
from talbot.pixels.blocks import AnalogSizes
from talbot.pixels.circuits import lane
from talbot.pixels.circuits.specification import LaneSpec
from talbot.platforms.analog import analog_masks
from talbot.platforms.sky130 import analog

pytestmark = pytest.mark.needs("layout")

MASKS = analog_masks("sky130")
SIZES = lane.size(LaneSpec.of(), analog)


def test_units_have_the_circuits_capacitance():
    for side, units in zip(edges(SIZES.dac, MASKS), (1, 0.5), strict=True):
        assert MASKS.mim_farad(side, side) == pytest.approx(units * SIZES.dac.unit, rel=0.003)
    with pytest.raises(ParameterError, match="cap_mim"):
        edges(replace(SIZES.dac, kind="fringe"), MASKS)


def test_a_lane_is_the_circuits_transistors_and_capacitors_in_its_place():
    made = lane_cell(MASKS, SIZES)
    box = made.cell.dbbox()
    assert box.width() < AnalogSizes().lane_um and box.height() < AnalogSizes().lanes_um
    own = {device.transistor.name for device in made.devices}
    assert len(own) == 152
    areas = {name: area / 2.7**2 for name, _, _, area, _ in made.plates}
    assert areas["dac_bit7"] == pytest.approx(128)
    assert areas["balance_refn"] == pytest.approx(128)
    assert areas["dac_half"] == pytest.approx(0.475, abs=0.001)  # its edge makes up for the area
