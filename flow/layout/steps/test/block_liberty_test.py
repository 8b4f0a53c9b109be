"""The timing at a block's ports, by hand; the Liberty generated from it, read back; faults in it are found."""

import json

import pytest

from talbot.base.steps import StepError
from talbot.flow.layout.steps.block_liberty import BlockLiberty, BlockLibertyParameters
from talbot.flow.layout.timing.boundary import Sources, measure, reach
from talbot.signoff.netlist.test import shift_register as small
from talbot.signoff.parasitics.spef import spef

pytestmark = pytest.mark.needs("openroad", "yosys")


@pytest.fixture
def files(tmp_path):
    """Inputs of BlockLiberty for the shift register: dict name -> path."""
    netlist = small.shift()
    netlist.write(tmp_path / "netlist.json")
    (tmp_path / "shift.v").write_text(netlist.verilog())
    (tmp_path / "small.lib").write_text(small.liberty())
    (tmp_path / "shift.spef").write_text(spef(netlist, {"w0": (0.001, 1.0)}))
    (tmp_path / "plan.json").write_text(json.dumps({"width_um": 4.0, "height_um": 5.0}))
    return {
        "netlist": tmp_path / "netlist.json",
        "verilog": tmp_path / "shift.v",
        "liberty": tmp_path / "small.lib",
        "spef": tmp_path / "shift.spef",
        "areas": tmp_path / "plan.json",
    }


def test_reach():
    assert reach(small.shift(), "clk") == ([("a", "n")], ["a"])


def test_delays_and_constraints_by_hand(files, tmp_path):
    found = measure(
        small.shift(), "clk", Sources(files["liberty"], files["verilog"], tmp_path, files["spef"]), (0.1,), (0.04,)
    )
    load = 0.001 + 0.999 / 0.999 * (0.04 - 0.001)  # the tables are straight: 1 ns over 0.999 pF
    rise = (load - 0.001) / 0.999
    assert found.delays["clk", "y", "rise"][0.1, 0.04] == pytest.approx(0.5 + rise, abs=1e-4)
    assert found.delays["a", "n", "fall"][0.1, 0.04] == pytest.approx(0.1 + rise, abs=1e-4)
    assert ("a", "y", "rise") not in found.delays
    assert found.checks["a", "max", "rise"][0.1, 0.1] == pytest.approx(0.2, abs=1e-4)  # setup
    assert found.checks["a", "min", "fall"][0.1, 0.1] == pytest.approx(0.1, abs=1e-4)  # hold
    assert found.capacitance == pytest.approx({"clk": 0.04, "a": 0.03})


def test_the_liberty_has_the_timing_of_the_block(files, tmp_path):
    step = BlockLiberty(BlockLibertyParameters("tt"))
    assert step.run(files, {"liberty": tmp_path / "block.lib"}) == {
        "model_error_ns": pytest.approx(0, abs=2e-4),
        "arcs": 4 + 4,
    }
    text = (tmp_path / "block.lib").read_text()
    assert 'voltage_map ("vdd", 2)' in text and "area : 20" in text and "cell_leakage_power : 20" in text


def test_a_model_without_an_arc_is_found(files, tmp_path):
    step = BlockLiberty(BlockLibertyParameters("tt"))
    step.run(files, {"liberty": tmp_path / "block.lib"})
    text = (tmp_path / "block.lib").read_text()
    (tmp_path / "block.lib").write_text(text.replace("hold_rising", "recovery_rising"))
    with pytest.raises(StepError, match="does not find the arcs"):
        step.model_error(
            small.shift(), Sources(files["liberty"], files["verilog"], tmp_path, files["spef"]), tmp_path / "block.lib"
        )
