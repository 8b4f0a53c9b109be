"""What constraints are measured in: found from a flip-flop's states."""

import pytest

from talbot.cells.characterize.cell import _between
from talbot.cells.characterize.scenario import Scenarios
from talbot.cells.netlist.function import understand
from talbot.cells.netlist.test.netlist_test import FLIP_FLOP, LATCH, POLARITY, RAILS, cell, gate, inverter


def scenarios(lines, ports):
    return Scenarios(understand(cell(lines, ports), POLARITY, RAILS))


@pytest.mark.parametrize("level", [0, 1])
def test_a_clock_pulse_must_pass_both_levels(level):
    """A flip-flop may take one level more slowly than the other: the longer pulse counts, so both are tried."""
    found = scenarios(FLIP_FLOP, "C D Q").pulses("C", level)
    assert [expected for _, expected in found] == [0, 1]
    for state, expected in found:
        assert state.outputs == (1 - expected,)


def test_a_latch_is_set_and_cleared_by_a_pulse_of_its_gate():
    assert [expected for _, expected in scenarios(LATCH, "D G Q").pulses("G", 1)] == [0, 1]


@pytest.mark.parametrize("early, kind", [(True, "setup"), (False, "hold")])
@pytest.mark.parametrize("to", [0, 1])
def test_setup_and_hold_expect_what_each_keeps(early, kind, to):
    """This flip-flop stores !D: with setup kept it takes the new value, with hold kept the old."""
    (found,) = getattr(scenarios(FLIP_FLOP, "C D Q"), kind)("D", to)
    assert (found.early, found.data_to, found.expected) == (early, to, 1 - to if early else to)


@pytest.mark.parametrize("kind", ["setup", "hold"])
def test_a_select_is_tried_with_both_levels(kind):
    """E chooses which of two inputs is stored: its setup time must do for a 0 and for a 1."""
    select = [*inverter("e", "E", "en"), *gate("a", "A", "D", "en", "E"), *gate("b", "B", "D", "E", "en")]
    found = scenarios([*select, *FLIP_FLOP], "A B C E Q")
    assert [s.expected for s in getattr(found, kind)("E", 1)] == [0, 1]
    assert all(s.moves and s.early == (kind == "setup") for s in getattr(found, kind)("E", 1))
    assert [s.expected for s in getattr(found, kind)("A", 1)] == [0 if kind == "setup" else 1]


def test_a_share_of_the_way_to_the_limit_is_by_factors():
    assert _between(1.0, 8.0, 2 / 3) == pytest.approx(4.0)
