"""Phases of a lane and its amplifier from the chip's signals, in ngspice."""

import pytest

from talbot.cells.corner import Corner
from talbot.pixels.circuits.amplifier import AmplifierSpec
from talbot.pixels.circuits.interface import STROBE
from talbot.pixels.circuits.specification import LaneSpec
from talbot.pixels.datasheet.deck import Setup
from talbot.pixels.datasheet.interface import measure

pytestmark = pytest.mark.needs("layout", "ngspice")

SPEC = AmplifierSpec()
DECISION = {"tt_027C_1v80": 1.97e-9, "ss_n40C_1v62": 2.88e-9, "ff_125C_1v98": 1.58e-9}  # s, of `make analog`
KEPT = 0.7e-9  # s after its sample for which a lane's input stays


@pytest.mark.parametrize("name", DECISION)
def test_a_lane_samples_after_its_last_decision_and_between_two_resets_whatever_the_clocks_duty_is(name):
    found = measure(Setup("sky130", LaneSpec()), Corner.parse(name))
    assert 4e-9 < found.first < found.last < STROBE
    assert found.last - found.first < 3e-9  # the first strobe after a rest is as late as `convert`
    assert found.decided > DECISION[name] and found.sample < SPEC.track and found.over > KEPT
    assert abs(found.idle) < 0.05e-12 < found.energy < 1e-12
