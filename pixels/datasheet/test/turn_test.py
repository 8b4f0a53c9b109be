"""A column's turn through the difference amplifier onto the lane's array: what a cycle leaves, and slow ones found."""

from dataclasses import replace

import pytest

from talbot.cells.corner import Corner
from talbot.pixels.circuits import column_block
from talbot.pixels.datasheet import job, turn

pytestmark = pytest.mark.needs("ngspice")
SETUP, LANE = job.setup_of("sky130")
CORNER = Corner.parse(job.TYPICAL)
SPEC, SIZES = job.column_of(SETUP)
SPEC_A, SIZES_A = job.amplifier_of(SETUP, LANE)


def test_a_cycle_is_enough_and_a_lane_with_a_quarter_of_its_current_is_found(monkeypatch):
    monkeypatch.setattr(turn, "LIGHT", ((0.9, 0.75),))
    monkeypatch.setattr(turn, "trimmed", lambda *_: (SPEC.dark - 0.067, SPEC.dark - 0.063))
    given = SETUP, (SPEC, SPEC_A), (SIZES, SIZES_A), LANE, CORNER
    sound = turn.measure(*given)
    assert sound.left < 0.1 and 40e-9 < sound.settling < 80e-9 and sound.runs == 1
    end = column_block.lane_end(SIZES)
    less = [one._replace(w=one.w / 4, fingers=4) if one.name == "top" else one for one in end.transistors]
    slow = turn.measure(*given, replace(end, transistors=tuple(less)))
    assert slow.settling > sound.settling + 5e-9 and slow.left > sound.left


def test_its_deck_has_the_amplifier_in_place_of_its_inputs():
    made = turn.joined(SIZES, SIZES_A, SPEC)
    assert not [one for one in made.capacitors if one.name.startswith("input_")]
    driver = next(one for one in made.instances if one.name == "driver")
    assert driver.nodes[:2] == ("far_a", "far_b") and {"out", "vref", "g9"} <= set(made.ports)
    made.check(job.process_of("sky130"))
