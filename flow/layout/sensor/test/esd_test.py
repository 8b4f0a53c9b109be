"""Discharges: the closed form of the pulse, every case of every pad, clamps that carry it."""

import math

import pytest

from talbot.flow.layout.sensor import esd
from talbot.flow.layout.sensor.steps.die_esd import fewest
from talbot.platforms.pads import esd_models, pad_process

pytestmark = pytest.mark.needs("layout", "ngspice")
PROCESS = pad_process("sky130")
# A pad that is a resistor of 1 ohm, and one of the pads' supply that does nothing
SHORT = """.subckt IOPadIn vss vdd iovdd p2c pad
Rpad pad vss 1.0000000000e+00 sky130_fd_pr__res_generic_po l=5e-06 w=1e-06
Rp2c p2c vss 1.0000000000e+03 sky130_fd_pr__res_generic_po l=5e-06 w=1e-06
.ends IOPadIn
.subckt IOPadIOVdd vss vdd iovdd
Riovdd iovdd vss 1.0000000000e+06 sky130_fd_pr__res_generic_po l=5e-06 w=1e-06
.ends IOPadIOVdd
"""
RESISTOR = """.subckt IOPadVddClamp vss vdd iovdd
Rvdd vdd vss 1.0000000000e+06 sky130_fd_pr__res_generic_po l=5e-06 w=1e-06
.ends IOPadVddClamp
"""
CLAMPED = SHORT.replace(
    ".ends IOPadIOVdd",
    "\n".join(
        f"Mclamp_g{k} vss iovdd iovdd vss sky130_fd_pr__nfet_g5v0d10v5__model l=6e-07 w=1.69e-05" for k in range(32)
    )
    + "\n.ends IOPadIOVdd",
)


def peak(pulse, ohm):
    """Largest current of a series circuit of capacitor, inductor and resistor, in closed form."""
    ohm += pulse.ohm
    damping, natural = ohm / 2 / pulse.henry, 1 / math.sqrt(pulse.henry * pulse.farad)
    if damping > natural:
        rate = math.sqrt(damping**2 - natural**2)
        at = math.atanh(rate / damping) / rate
        return pulse.volts / pulse.henry / rate * math.exp(-damping * at) * math.sinh(rate * at)
    rate = math.sqrt(natural**2 - damping**2)
    at = math.atan2(rate, damping) / rate
    return pulse.volts / pulse.henry / rate * math.exp(-damping * at) * math.sin(rate * at)


@pytest.mark.parametrize("pulse", [esd.HBM, esd.CDM])
@pytest.mark.parametrize("sign", [1, -1])
def test_a_resistor_has_the_closed_forms_peak(pulse, sign):
    lines = esd_models("sky130").lines(SHORT)
    found = esd.stress(lines, PROCESS, "IOPadIn", "pad", pulse, "vss", sign, 1)
    assert found.ampere == pytest.approx(peak(pulse, 1.1), rel=0.02)  # 0.1 of the switch
    assert found.pad == pytest.approx(found.ampere, rel=0.01) and found.volts == sign * pulse.volts


def test_two_clamps_carry_it_at_a_lower_voltage():
    """32 fingers with their gates on their drains: of two pads each has half of the current."""
    lines = esd_models("sky130").lines(CLAMPED)
    assert sum(line.startswith("X") for line in lines) == 1 and any(line.endswith("m=32") for line in lines)
    one, two = (esd.stress(lines, PROCESS, "IOPadIOVdd", "iovdd", esd.HBM, "vss", 1, n) for n in (0, 1))
    assert one.ampere == pytest.approx(two.ampere, rel=0.02) and 4 < two.pad < 0.9 * one.pad


def test_every_pad_is_stressed_both_ways():
    cases = list(esd.cases(PROCESS))
    assert len(set(cases)) == len(cases) == 4 * 8 + 4
    assert {case[0] for case in cases} == {
        *PROCESS.signals.values(),
        *(PROCESS.supplies[pin] for pin in ("vdd", "iovdd")),
    }


def test_the_core_pads_of_the_segment_lower_its_voltage():
    """The other pad of the core's supply is 1 ohm to the ground."""
    lines = esd_models("sky130").lines(SHORT + RESISTOR + RESISTOR.replace("IOPadVddClamp", "Pad"))
    lines = [line.replace("1.0000000000e+06", "1") if line.startswith("Rvdd") else line for line in lines]
    alone, both = (esd.stress(lines, PROCESS, "Pad", "vdd", esd.HBM, "vss", 1, 1, n) for n in (0, 1))
    assert both.core == pytest.approx(alone.core / 2, rel=0.02)


def test_a_resistor_conducts_in_operation_what_ohm_says():
    """1 Mohm: at rest, under a ripple whose mean is 0, and while the supply rises."""
    lines = esd_models("sky130").lines(RESISTOR)
    currents = esd.quiet(lines, lines, PROCESS)
    assert all(ampere == pytest.approx(PROCESS.core_v / 1e6, rel=0.01) for ampere in currents)


def test_the_net_with_the_fewest_clamps_is_the_worst():
    ring = [{"cell": cell, "nets": {"vdd": net}} for cell, net in (("Core", "a"), ("Core", "a"), ("Core", "b"))]
    ring.append({"cell": "Filler", "nets": {}})
    assert fewest(ring, "vdd", "Core") == 1
    ring.append({"cell": "Input", "nets": {"vdd": "c"}})
    assert fewest(ring, "vdd", "Core") == 0
