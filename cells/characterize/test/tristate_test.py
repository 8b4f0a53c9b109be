"""A tri-state inverter of our own: when it lets go, and what its output then weighs."""

import pytest

from talbot.cells.characterize.bench import Bench
from talbot.cells.characterize.conditions import Conditions
from talbot.cells.characterize.tristate import Held, disable
from talbot.cells.corner import Corner
from talbot.cells.netlist.function import understand
from talbot.cells.netlist.spice import parse
from talbot.platforms.sky130 import models

pytestmark = pytest.mark.needs("ngspice", "layout")
CONDITIONS = Conditions(Corner("tt", 25, 1.8))
INVERTER = """.subckt tri A E Z VPWR VGND
Xn0 Z E m VGND sky130_fd_pr__nfet_01v8 w=0.65 l=0.15 m={many}
Xn1 m A VGND VGND sky130_fd_pr__nfet_01v8 w=0.65 l=0.15 m={many}
Xp0 Z en k VPWR sky130_fd_pr__pfet_01v8_hvt w=1 l=0.15 m={many}
Xp1 k A VPWR VPWR sky130_fd_pr__pfet_01v8_hvt w=1 l=0.15 m={many}
Xn2 en E VGND VGND sky130_fd_pr__nfet_01v8 w=0.65 l=0.15
Xp2 en E VPWR VPWR sky130_fd_pr__pfet_01v8_hvt w=1 l=0.15
.ends
"""


def held(many):
    """(Cell, Bench, Held) not entered, with ``many`` transistors in parallel at the output."""
    cell = understand(parse(INVERTER.format(many=many)), models.POLARITY, models.SUPPLIES)
    bench = Bench(cell, models, CONDITIONS)
    return cell, bench, Held(bench, "Z", models)


@pytest.fixture(scope="module")
def single():
    cell, bench, at = held(1)
    with bench, at:
        yield {arc.edge: arc for arc in cell.arcs if arc.type == "three_state_disable"}, at


def test_its_own_gate_lets_go_before_one_behind_an_inverter(single):
    """E falls: the n transistor's gate is E itself, the p transistor's comes an inverter later."""
    arcs, at = single
    from_low, from_high = (at.let_go(arcs[edge].changes[0], 0.05e-9) for edge in ("rise", "fall"))
    assert 0 < from_low < from_high < 0.3e-9


def test_behind_a_slow_ramp_the_same_level_counts(single):
    """Where nothing but the gate's level matters, the time is a fixed share of the ramp: a transistor whose gate has

    half the supply drives a tenth, so that it is near the ramp's middle.
    """
    arcs, at = single
    short, long = (at.let_go(arcs["rise"].changes[0], slew) / slew for slew in (2e-9, 8e-9))
    assert short == pytest.approx(long, rel=0.05) and abs(long) < 0.1 * CONDITIONS.ramp(1.0)


def test_a_table_has_the_same_time_for_every_load_and_no_slew(single):
    arcs, at = single
    table = disable(at, arcs["fall"], (0.01e-9, 0.1e-9, 1e-9), (1e-15, 1e-14))
    assert [row[0] for row in table["delay"]] == [row[1] for row in table["delay"]]
    assert table["slew"] == [[0.0, 0.0]] * 3 and table["state"] == [0, 1]


def test_twice_the_transistors_weigh_twice(single):
    _, at = single
    _, bench, double = held(2)
    with bench, double:
        for one, two in zip(at.capacitance(), double.capacitance(), strict=True):
            assert 0.3e-15 < one < 5e-15 and two == pytest.approx(2 * one, rel=0.05)
