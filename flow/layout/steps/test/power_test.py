"""The power step and the IR drop after it, on the shift register: totals, blocks, causes."""

import json

import pytest

from talbot.flow.layout.power.energy import Cells, powers
from talbot.flow.layout.power.test.energy_test import ACTIVITY
from talbot.flow.layout.steps.ir_drop import IrDrop, IrDropParameters
from talbot.flow.layout.steps.power import Power, PowerParameters, wire_pf
from talbot.signoff.netlist.test import shift_register as small
from talbot.signoff.parasitics.spef import spef

pytestmark = pytest.mark.needs("openroad")


@pytest.fixture
def inputs(tmp_path):
    netlist = small.shift()
    netlist.write(tmp_path / "netlist.json")
    files = {
        "verilog": netlist.verilog(),
        "spef": spef(netlist, {"w0": (90.0, 1.0), "y": (500.0, 1.0)}),
        "sdc": "create_clock -name clk -period 10 [get_ports clk]\n",
        "liberty": small.liberty(),
        "activity": json.dumps(ACTIVITY),
    }
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    return {name: tmp_path / name for name in files} | {"netlist": tmp_path / "netlist.json"}


def measured(inputs, folder):
    return Power(PowerParameters("Shift", "tt", 10.0)).run(inputs, {"instances": folder / "power.json"})


def test_the_total_is_that_of_the_cells(inputs, tmp_path):
    from talbot.base.liberty.read import parse

    found = measured(inputs, tmp_path)
    wires = wire_pf(inputs["spef"].read_text())
    assert wires == {"w0": 0.09, "y": 0.5}
    by_hand = powers(small.shift(), Cells(parse(small.liberty())), ACTIVITY, wires, {}, 10.0)  # tables: the same slews
    assert found["power_uw"] == pytest.approx(sum(power.total for power in by_hand.values()), rel=1e-6)
    assert sum(found["by_kind"].values()) == pytest.approx(found["power_uw"], abs=1e-3)
    assert sum(found["by_block"].values()) == pytest.approx(found["power_uw"], abs=1e-3)
    assert set(found["by_block"]) == {"first", "second", "ports"}
    assert found["energy_pj_cycle"] == pytest.approx(found["power_uw"] * 10 / 1000, rel=1e-3)


def test_the_drop_is_that_of_the_power(inputs, tmp_path):
    measured(inputs, tmp_path)
    netlist = small.shift()
    placed = [[k, i.cell, 4.8 * k, 0.0, "0"] for k, i in enumerate(netlist.instances)]
    (tmp_path / "placement").write_text(json.dumps({"instances": placed, "straps": [["vss", 4.0], ["vdd", 16.0]]}))
    (tmp_path / "plan").write_text(json.dumps({"width_um": 20.0, "height_um": 11.2, "core": [0.0, 0.0, 20.0, 11.2]}))
    (tmp_path / "areas").write_text(json.dumps({"dff_x1": 5.6 * 4.8, "inv_x1": 5.6 * 1.6}))
    given = {name: tmp_path / name for name in ("placement", "plan", "areas")} | {
        "netlist": inputs["netlist"],
        "power": tmp_path / "power.json",
    }
    outputs = {"picture": tmp_path / "drop.png", "cells": tmp_path / "drop.json"}
    step = IrDrop(IrDropParameters("sky130", "tt"))
    once = step.run(given, outputs)
    drawn = sum(json.loads((tmp_path / "power.json").read_text()).values())
    assert once["current_ua"] == pytest.approx(drawn / 1.8, rel=1e-3) and once["current_lost"] < 1e-9
    (tmp_path / "power.json").write_text(
        json.dumps({name: 1000 * power for name, power in json.loads((tmp_path / "power.json").read_text()).items()})
    )
    assert step.run(given, outputs)["supply_drop_mv"] == pytest.approx(1000 * once["supply_drop_mv"], rel=1e-3)
    assert (tmp_path / "drop.png").stat().st_size > 5000
