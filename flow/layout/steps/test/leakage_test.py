"""Leakage of a netlist of three cells at two corners."""

import json

import pytest

from talbot.flow.layout.steps.leakage import Leakage, LeakageParameters
from talbot.signoff.netlist.test import shift_register as small

LIBERTY = """library(one) {{ leakage_power_unit : "1nW"; nom_voltage : 1.8;
  cell(dff_x1) {{ cell_leakage_power : {register}; }} cell(inv_x1) {{ cell_leakage_power : {inverter}; }} }}"""


def test_each_corner_is_the_sum_of_its_cells(tmp_path):
    netlist = small.shift()
    count = {kind: sum(i.cell == kind for i in netlist.instances) for kind in ("dff_x1", "inv_x1")}
    netlist.write(tmp_path / "netlist.json")
    nw = {"tt": (2.0, 0.5), "ss": (700.0, 90.0)}
    for corner, (register, inverter) in nw.items():
        (tmp_path / f"{corner}.lib").write_text(LIBERTY.format(register=register, inverter=inverter))
    step = Leakage(LeakageParameters(tuple(nw)))
    inputs = {"netlist": tmp_path / "netlist.json"} | {corner: tmp_path / f"{corner}.lib" for corner in nw}
    assert step.inputs.keys() == inputs.keys()
    found = step.run(inputs, {"kinds": tmp_path / "kinds.json"})["leakage_uw"]
    expected = {c: (count["dff_x1"] * r + count["inv_x1"] * i) / 1000 for c, (r, i) in nw.items()}
    assert found == pytest.approx(expected) and min(found.values()) > 0
    kinds = json.loads((tmp_path / "kinds.json").read_text())
    assert sum(kinds["ss"].values()) == pytest.approx(found["ss"])
