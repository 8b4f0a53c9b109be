"""Circuits as data: their pins, sizes and faults; what ngspice says of them is tested in pixels/datasheet."""

from dataclasses import replace

import pytest

from talbot.models.parameters import ParameterError
from talbot.pixels.circuits import comparator, dac, lane
from talbot.pixels.circuits.netlist import Circuit, Instance, Resistor, Transistor
from talbot.pixels.circuits.specification import LaneSpec
from talbot.platforms.sky130 import analog as process

SPEC = LaneSpec.of()
SIZES = lane.size(SPEC, process)
LANE = lane.sar_lane(SIZES)


def test_specification_is_the_sensors():
    assert SPEC.f_clk == 10e6 and SPEC.half_cycle == 50e-9
    assert SPEC.lsb == pytest.approx(1.2 / 256)
    # Table 6.1: 100 uW, here at 30 frames of 384 x 384 samples of 8 decisions
    assert SPEC.decision_energy == pytest.approx(100e-6 / (30 * 384 * 384 * 8), rel=0.07)  # to one digit
    assert SPEC.decision_energy == 3e-12


@pytest.mark.parametrize(
    "changes", [{"refp": 0.2}, {"refp": 1.9}, {"offset": 0.0}, {"f_clk": float("nan")}, {"comparator_share": 1.0}]
)
def test_a_value_out_of_range_is_refused_by_name(changes):
    with pytest.raises(ParameterError, match=f"{next(iter(changes))} = "):
        replace(SPEC, **changes)


def test_the_unit_capacitor_is_the_smallest_that_matches():
    """Three sigma of sqrt(255) units are half an LSB; the other kind of cell is larger."""
    assert 3 * 255**0.5 * SIZES.dac.unit_mismatch <= 0.5
    assert SIZES.attenuation >= dac.LEAST_ATTENUATION
    loads = SIZES.comparator.input_capacitance
    kinds = {dac.size(SPEC, process, load).kind for load in (0.0, loads)}
    assert SIZES.dac.kind in kinds
    looser = dac.size(replace(SPEC, dnl=1.0), process, 0.0)
    assert looser.area < SIZES.dac.area


def test_a_smaller_offset_takes_a_larger_pair():
    """Pelgrom: half the offset, four times the area."""
    wide, narrow = (comparator.size(replace(SPEC, offset=x), process).input_w for x in (0.5, 1.0))
    assert wide / narrow == pytest.approx(4, rel=0.03)


def test_the_lane_is_whole():
    LANE.check(process)
    lines = LANE.lines(process)
    assert lines[-1] == ".ends sar_lane" and any(
        line.startswith(".subckt comparator inp inn strobe q") for line in lines
    )
    assert f".subckt sar_lane {' '.join(lane.PINS)}" in lines
    units = [c.units for c in LANE.circuits()["dac"].capacitors if c.name.startswith("bit")]
    assert units == [128, 64, 32, 16, 8, 4, 2, 1]


INVERTER = Circuit(
    "one",
    ("a", "y", "vdd", "vss"),
    (Transistor("n", "y", "a", "vss", "vss", "n", 1.0, 0.15), Transistor("p", "y", "a", "vdd", "vdd", "p", 2.0, 0.15)),
)


@pytest.mark.parametrize(
    "change, named",
    [
        ({"role": "q"}, "device n: role"),
        ({"l": 0.1}, "device n: l = 0.1"),
        ({"w": 200.0}, "device n: w = 200"),
        ({"w": float("nan")}, "device n: w = nan"),
        ({"gate": "b"}, "net b at device n: must have a driver"),
        ({"source": "nowhere"}, "net nowhere at device n: must have two ends"),
        ({"name": "p"}, "devices: duplicate name p"),
        ({"drain": ""}, "device n: node"),
    ],
)
def test_a_broken_device_is_named(change, named):
    INVERTER.check(process)
    broken = replace(INVERTER, transistors=(INVERTER.transistors[0]._replace(**change), INVERTER.transistors[1]))
    with pytest.raises(ParameterError, match=f"circuit one: {named}"):
        broken.check(process)


def test_a_broken_device_inside_is_named():
    inner = replace(INVERTER, resistors=(Resistor("r", "a", "y", 0.0),))
    outer = Circuit("outer", ("a", "y", "vdd", "vss"), instances=(Instance("x", inner, ("a", "y", "vdd", "vss")),))
    with pytest.raises(ParameterError, match="circuit one: device r: value = 0"):
        outer.check(process)
    wrong = replace(outer, instances=(Instance("x", INVERTER, ("a", "y")),))
    with pytest.raises(ParameterError, match="device x: nodes = 2: must be 4"):
        wrong.check(process)
    with pytest.raises(ParameterError, match="device = nothing"):
        outer.without("nothing")
