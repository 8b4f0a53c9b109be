"""OpenROAD's OpenSTA knows every command of every script that is given to it, and a name that it does not know of
a SPEF ends a step."""

import re

import pytest

from talbot.base import openroad
from talbot.base.steps import StepError
from talbot.base.tools import run
from talbot.flow.layout.design import DESIGNS
from talbot.flow.layout.steps import power, sta
from talbot.flow.layout.timing import boundary
from talbot.flow.layout.timing.constraints import sdc
from talbot.platforms.wires import CORNERS
from talbot.signoff.netlist.test import shift_register as small
from talbot.signoff.parasitics.spef import spef

pytestmark = pytest.mark.needs("openroad")
SCRIPTS = {
    "sta": sta.SCRIPT + sta.OTHER,
    "power": power.SLEWS,
    "load": boundary.LOAD,
    "outputs": boundary.OUTPUTS,
    "through": boundary.THROUGH,
    "constraints": boundary.CONSTRAINTS,
    "ports": boundary.PORTS,
    "sdc": sdc(DESIGNS["quad_divider"]),
}


def commands(script):
    """Names in the place of a Tcl command: the first word of a line, after a semicolon, in brackets."""
    text = script.replace("{{", "{").replace("}}", "}")
    return sorted(set(re.findall(r"(?m)(?:^|;)\s*([a-z_]+)(?=\s|$)", text)) | set(re.findall(r"\[([a-z_]+)", text)))


def test_every_command_is_known(tmp_path):
    ours = set(re.findall(r"(?m)^proc (\w+)", "\n".join(SCRIPTS.values())))
    names = sorted({name for script in SCRIPTS.values() for name in commands(script)} - ours)
    assert {"read_spef", "set_output_delay", "find_timing_paths", "report_net", "write_sdf"} <= set(names)
    (tmp_path / "ask.tcl").write_text(
        "".join(f'if {{[info commands {name}] eq ""}} {{ puts "UNKNOWN {name}" }}\n' for name in names) + "exit\n"
    )
    assert "UNKNOWN" not in run(openroad.command(tmp_path / "ask.tcl"))


@pytest.fixture
def inputs(tmp_path):
    """Of the Sta step, for the shift register at 100 MHz."""
    netlist = small.shift()
    (tmp_path / "shift.v").write_text(netlist.verilog())
    (tmp_path / "small.lib").write_text(small.liberty())
    (tmp_path / "wires.spef").write_text(spef(netlist, {"w0": (10.0, 1.0)}))
    (tmp_path / "shift.sdc").write_text(
        "create_clock -name clk -period 10 [get_ports clk]\nset_input_delay 0 -clock clk [get_ports a]\n"
    )
    return {
        "verilog": tmp_path / "shift.v",
        "liberty": tmp_path / "small.lib",
        "spef": tmp_path / "wires.spef",
        "sdc": tmp_path / "shift.sdc",
    } | dict.fromkeys(CORNERS, tmp_path / "wires.spef")


def timed(inputs, folder):
    step = sta.Sta(sta.StaParameters("Shift", "tt", 10.0))
    return step.run(inputs, {name: folder / file for name, file in step.outputs.items()})


def test_slacks_by_hand(inputs, tmp_path):
    found = timed(inputs, tmp_path)
    driven = (0.5 + (0.01 + 0.01 - 0.001) / 0.999) + (0.1 + (0.02 - 0.001) / 0.999)  # the wire's 10 fF and pins
    assert found["wns_ns"] == pytest.approx(10 - 0.2 - driven, abs=2e-3)
    assert found["f_max_mhz"] == pytest.approx(1000 / (driven + 0.2), rel=1e-3)


def test_a_race_is_negative_slack_of_hold(inputs, tmp_path):
    inputs["liberty"].write_text(small.liberty(hold=2.0))
    assert timed(inputs, tmp_path)["whs_ns"] < 0


def test_a_name_that_opensta_does_not_know_ends_the_step(inputs, tmp_path):
    inputs["spef"].write_text(inputs["spef"].read_text().replace("u0:i", "u99:i"))
    with pytest.raises(StepError, match="does not know a name of the SPEF.*u99"):
        timed(inputs, tmp_path)
