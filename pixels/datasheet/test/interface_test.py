"""Phases of a lane and its amplifier from the chip's signals, in ngspice."""

import numpy as np
import pytest

from talbot.cells.corner import Corner
from talbot.pixels.circuits.amplifier import AmplifierSpec
from talbot.pixels.circuits.interface import interface
from talbot.pixels.circuits.specification import LaneSpec
from talbot.pixels.datasheet.deck import EDGE, Setup, deck, simulator

pytestmark = pytest.mark.needs("layout", "ngspice")

SPEC = AmplifierSpec()
DECISION = {"tt_027C_1v80": 1.97e-9, "ss_n40C_1v62": 2.88e-9, "ff_125C_1v98": 1.58e-9}  # s, of `make analog`
KEPT = 1e-9  # s after its sample for which a lane's input stays: AFTER of verif/cosim/amplified.py
LOADS = {"sample": 20e-15, "strobe": 20e-15, "reset": 0.2e-12}


@pytest.mark.parametrize("name", DECISION)
def test_a_lane_samples_after_its_last_decision_and_between_two_resets(name):
    corner, hold = Corner.parse(name), SPEC.hold
    high = corner.supply

    def pulses(*times):
        points = [(0.0, 0.0)]
        for k, when in enumerate(times):
            points += [(when, high * (k % 2)), (when + EDGE, high * (1 - k % 2))]
        return points

    lines = deck(interface(), Setup("sky130", LaneSpec()), corner)
    with simulator(lines, ("hold", "en", "clk"), tuple(LOADS), corner) as spice:
        stimulus = {
            "clk": pulses(hold, hold + SPEC.high, 2 * hold, 2 * hold + SPEC.high),
            "hold": pulses(hold + 1e-9, 2 * hold + 1e-9),
        }
        wave = spice.transient(stimulus | {"en": [(0.0, high)]}, LOADS, 3 * hold, hold / 100)
        off = spice.transient(stimulus | {"en": [(0.0, 0.0)]}, LOADS, 3 * hold, hold / 100)

    def edges(net):
        above = wave.voltage[net] > high / 2
        return wave.time[1:][above[1:] != above[:-1]]

    begin, end = edges("sample")
    strobe, reset = edges("strobe"), edges("reset")
    decided = strobe[strobe < begin].max() + DECISION[name]
    assert decided < begin < hold + SPEC.track + 1e-9
    assert reset.min() < begin and end + KEPT < reset.max()
    assert np.max(off.voltage["sample"]) < 0.1 * high
