"""Power of a shift register, by hand."""

from dataclasses import replace

import pytest

from talbot.base.liberty.read import parse
from talbot.base.steps import StepError
from talbot.flow.layout.power.energy import Cells, blocks, powers
from talbot.signoff.netlist.netlist import Instance, Netlist, is_register
from talbot.signoff.netlist.test import shift_register as small

ACTIVITY = {"clk": (2.0, 0.5), "a": (0.5, 0.5), "w0": (0.4, 0.5), "w1": (0.3, 0.5), "y": (0.2, 0.5), "n": (0.5, 0.5)}


def test_powers_by_hand():
    cells = Cells(parse(small.liberty()))
    found = powers(small.shift(), cells, ACTIVITY, {"w0": 0.09, "y": 0.5}, {}, period_ns=10.0)
    mega = 100.0  # cycles a us
    first = found["first.d_reg"]
    assert first.internal == pytest.approx((2 * (0.5 + 1.5) / 2 + 0.4 * (2.0 + 4.0) / 2) * mega)
    assert first.switching == pytest.approx(0.5 * (0.09 + 0.01) * 4 * 0.4 * mega)  # its wire and u0's pin
    assert first.leakage == pytest.approx(0.005)
    inverter = found["u0"]
    assert inverter.internal == pytest.approx(0.3 * 0.3 * mega)
    assert inverter.switching == pytest.approx(0.5 * 0.02 * 4 * 0.3 * mega)


def test_power_follows_the_transitions():
    cells = Cells(parse(small.liberty()))
    still = powers(small.shift(), cells, dict.fromkeys(ACTIVITY, (0.0, 0.5)), {}, {}, 10.0)
    assert all(power.total == pytest.approx(0.005) for power in still.values())
    extreme = powers(small.shift(), cells, dict.fromkeys(ACTIVITY, (1000000000.0, 0.5)), {}, {}, 10.0)
    once = powers(small.shift(), cells, dict.fromkeys(ACTIVITY, (1.0, 0.5)), {}, {}, 10.0)
    for name in once:
        assert extreme[name].total - 0.005 == pytest.approx(1e9 * (once[name].total - 0.005), rel=1e-9)


def test_a_net_without_activity_is_named():
    without = {net: activity for net, activity in ACTIVITY.items() if net != "w1"}
    with pytest.raises(StepError, match="w1"):
        powers(small.shift(), Cells(parse(small.liberty())), without, {}, {}, 10.0)


def test_a_cell_belongs_to_what_it_drives():
    netlist = small.shift()
    clock = (Instance("b", "buf_x1", {"i": "clk", "q": "leaf"}),)
    moved = tuple(
        Instance(i.name, i.cell, i.pins | {"clk": "leaf"}) if is_register(i.cell) else i for i in netlist.instances
    )
    gate = Instance("g", "cg_x1", {"i": "n_go", "clk": "clk", "q": "gated"})
    enable = Instance("e", "inv_x1", {"i": "a", "nq": "n_go"})
    gated = tuple(replace(i, pins=i.pins | {"clk": "gated"}) if i.name.startswith("second") else i for i in moved)
    found = blocks(Netlist("Shift", netlist.ports, (*gated, *clock, gate, enable)))
    assert found["g"] == "clock tree" and found["e"] == "second"
    assert blocks(Netlist("Shift", netlist.ports, moved + clock)) == {
        "first.d_reg": "first",
        "second.d_reg": "second",
        "u0": "second",
        "u_n": "ports",
        "b": "clock tree",
    }
