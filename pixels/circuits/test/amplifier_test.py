"""The amplifier as data: both inputs see the same, the trim is binary, and a broken one is named."""

from dataclasses import replace

import pytest

from talbot.models.parameters import ParameterError
from talbot.pixels.circuits.amplifier import (
    BIAS,
    EFFICIENCY,
    LEG,
    PINS,
    SINKS,
    SPLIT,
    TRIM_BITS,
    UNITS,
    AmplifierSpec,
    amplifier,
    ota,
    size,
)
from talbot.platforms.sky130 import analog as process

SPEC = AmplifierSpec()
SIZES = size(SPEC, 4.7e-12, process)
AMPLIFIER = amplifier(SIZES)


def test_specification_is_the_sensors():
    spec = AmplifierSpec.of()
    assert spec.hold == 100e-9 and spec.swing == 1.0
    # Table 6.1: 900 uW, here at 30 frames of 384 x 384 samples
    assert spec.energy == pytest.approx(900e-6 / (30 * 384 * 384), rel=0.02)  # to one digit
    assert spec.energy == 200e-12


@pytest.mark.parametrize(
    "changes", [{"vref": 0.2}, {"gain": 0.0}, {"hold": float("nan")}, {"trim": 17}, {"energy": 0}, {"track": 5e-9}]
)
def test_a_limit_out_of_range_is_refused_by_name(changes):
    with pytest.raises(ParameterError, match=f"{next(iter(changes))} = "):
        replace(AmplifierSpec(), **changes)


@pytest.mark.parametrize("changes", [{"unit": 0.0}, {"gain": 17}])
def test_a_size_out_of_range_is_refused_by_name(changes):
    with pytest.raises(ParameterError, match=f"{next(iter(changes))} = "):
        replace(SIZES, **changes)


@pytest.mark.parametrize("gain", [1.0, 2.4, 7.3])
def test_both_inputs_have_the_same_capacitance(gain):
    """Else (Ca a - Cb b) / Cf has another gain for b."""
    total = {"xm": 0.0, "xp": 0.0}
    for one in amplifier(replace(SIZES, gain=gain)).capacitors:
        total[one.a] += one.value
    assert total["xm"] == pytest.approx(total["xp"], rel=1e-12)
    assert total["xm"] == pytest.approx((2 * UNITS + UNITS / gain) * SIZES.unit)


def test_the_amplifier_is_whole_and_its_trim_binary():
    AMPLIFIER.check(process)
    assert f".subckt amplifier {' '.join(PINS)}" in AMPLIFIER.lines(process)
    trim = {one.name: one.units for one in AMPLIFIER.capacitors if one.name[1:].isdigit()}
    assert trim == {f"b{k}": 1 << k for k in range(TRIM_BITS)}


def test_the_current_follows_from_time_and_load():
    """A tail of twice the parts for a little more than twice the load, and for half the time."""
    tails = SIZES.ota.tails
    assert 1.9 * tails < size(SPEC, 10e-12, process).ota.tails < 2.6 * tails
    slower = replace(SPEC, hold=183e-9, sample=3e-6)  # twice what is left of a cycle after track and slewing
    assert size(slower, 4.7e-12, process).ota.tails < 0.65 * tails
    # A pair that works at gm / I has gm / 2 of the tail's current on each side
    current = tails * LEG * BIAS / 2
    assert process.operating("p_lvt", 0.5, EFFICIENCY["pair"]).density == pytest.approx(
        current / SIZES.ota.pair, rel=0.1
    )


def test_sinks_are_their_diodes_and_carry_the_pair():
    """A sink is SINKS diodes, the pair's parts are as SPLIT says: what is above one is the branch's."""
    devices = {}
    for t in ota(SIZES.ota).transistors:
        name = t.name.rstrip("0123456789").rstrip("_")
        devices[name] = devices.get(name, 0) + t.w
    assert devices["sink_p"] == pytest.approx(SINKS * devices["diode_p"])
    assert devices["inp"] == pytest.approx((SPLIT - 1) * devices["inp_steer"], rel=1e-3)
    assert SINKS > SPLIT - 1 and devices["sink_n"] == devices["sink_p"]


def test_a_missing_capacitor_or_switch_is_named():
    with pytest.raises(ParameterError, match="circuit amplifier: net bottom5 at device select5: must have two ends"):
        AMPLIFIER.without("b5").check(process)
    broken = AMPLIFIER.replaced(ota(SIZES.ota).without("cascode_p").without("bias_to_pc"))
    with pytest.raises(ParameterError, match="circuit ota: net vcp at device down_p: must have a driver"):
        broken.check(process)


def test_the_chips_trim_has_its_top_bit_inverted():
    plain, own = ({one.name: one.nodes for one in amplifier(SIZES, chip).instances} for chip in (False, True))
    (name,) = (name for name in plain if plain[name] != own[name])
    assert name == "select9"
    assert own[name][2:4] == plain[name][3:1:-1] == ("g9n", "g9")
