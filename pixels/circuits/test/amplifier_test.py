"""The amplifier as data: both inputs see the same, the trim is binary, and a broken one is named."""

from dataclasses import replace

import pytest

from talbot.models.parameters import ParameterError
from talbot.pixels.circuits.amplifier import BIAS, PINS, TRIM_BITS, UNITS, AmplifierSizes, AmplifierSpec, amplifier, ota
from talbot.platforms.sky130 import analog as process

SIZES = AmplifierSizes()
AMPLIFIER = amplifier(SIZES)


def test_specification_is_the_sensors():
    spec = AmplifierSpec.of()
    assert spec.hold == 100e-9 and spec.swing == 1.0
    # Table 6.1: 900 uW, here at 30 frames of 384 x 384 samples
    assert spec.energy == pytest.approx(900e-6 / (30 * 384 * 384))


@pytest.mark.parametrize("changes", [{"vref": 0.2}, {"gain": 0.0}, {"hold": float("nan")}, {"trim": 17}, {"energy": 0}])
def test_a_limit_out_of_range_is_refused_by_name(changes):
    with pytest.raises(ParameterError, match=f"{next(iter(changes))} = "):
        replace(AmplifierSpec(), **changes)


@pytest.mark.parametrize("changes", [{"unit": 0.0}, {"gain": 17}, {"scale": 1.5}])
def test_a_size_out_of_range_is_refused_by_name(changes):
    with pytest.raises(ParameterError, match=f"{next(iter(changes))} = "):
        replace(SIZES, **changes)


@pytest.mark.parametrize("gain", [1.0, 2.4, 7.3])
def test_both_inputs_have_the_same_capacitance(gain):
    """Else (Ca a - Cb b) / Cf has a gain of its own for b."""
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


def test_currents_of_tail_and_sinks_fit():
    """A sink carries half of the tail's current and the branch's; both are mirrors of the bias."""
    w = {t.name: t.w for t in ota(1.0).transistors}
    bias_p = BIAS * w["bias_to_p"] / w["bias_n"]
    tail = bias_p * sum(w[f"tail_{k}"] for k in range(3)) / w["bias_p"]
    sink = BIAS * w["sink_p"] / w["bias_n"]
    assert w["sink_p"] == w["sink_n"] and sink - tail / 2 > 0.2 * sink
    half = {t.name: t.w for t in ota(0.5).transistors}
    assert half["sink_p"] == w["sink_p"] / 2 and half["bias_n"] == w["bias_n"]


def test_a_missing_capacitor_or_switch_is_named():
    with pytest.raises(ParameterError, match="circuit amplifier: net bottom5 at device select5: must have two ends"):
        AMPLIFIER.without("b5").check(process)
    broken = AMPLIFIER.replaced(ota(1.0).without("bias_p").without("bias_to_p"))
    with pytest.raises(ParameterError, match="circuit ota: net vbp at device bias_to_n: must have a driver"):
        broken.check(process)
