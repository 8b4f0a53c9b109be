"""The stages up to the clock tree in the real OpenROAD, on a shift register of the foundry's cells from their wheel."""

import re

import pytest

from talbot.base import openroad
from talbot.base.tools import finish
from talbot.flow.layout.design import design
from talbot.flow.layout.steps.stage import SCRIPTS
from talbot.flow.layout.timing.constraints import sdc
from talbot.flow.layout.variables import Floor, variables
from talbot.flow.openroad.test import librelane_pdk
from talbot.platforms.openroad import openroad_platform

pytestmark = pytest.mark.needs("openroad", "layout")
KNOWN, BITS = openroad_platform("sky130"), 40
CELL = f"  {KNOWN.library}__{{}} {{}} ({{}});"
REPORT = "source common.tcl\nopen_stage cts\nwrite_verilog cts.v\n"
HALVE = "foreach net {y q[7]} { buffer_halfway [[ord::get_db_block] findNet $net] }\nwrite_verilog halved.v\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with a netlist, all that the scripts read, and what they wrote."""
    folder, root = tmp_path_factory.mktemp("shift"), tmp_path_factory.mktemp("pdk")
    librelane_pdk.make(root)
    (liberty,) = (path for path in root.rglob("*.lib") if KNOWN.corners[0] in path.name)
    cells = root / KNOWN.cell_lef
    cells.write_text(re.sub(r"VERSION 5\.\d", "VERSION 5.8", cells.read_text()))  # of many files, some of old versions
    lines = ["module Shift (clk, a, y);", "  input clk, a;", "  output y;", f"  wire [{BITS}:0] q;"]
    lines.append(CELL.format("buf_1", "first", ".A(a), .X(q[0])"))
    lines += [CELL.format("dfxtp_1", f"r{k}", f".D(q[{k}]), .CLK(clk), .Q(q[{k + 1}])") for k in range(BITS)]
    lines += [CELL.format("buf_1", "last", f".A(q[{BITS}]), .X(y)"), "endmodule", ""]
    corner = KNOWN.corners[0]
    files = {"closed": (), "clock": "", "corners": (corner,), "liberty": {corner: str(liberty)}}
    files |= {"tech_lef": str(root / KNOWN.tech_lef), "cell_lef": str(cells)}
    (folder / "netlist.v").write_text("\n".join(lines))
    (folder / "Shift.sdc").write_text(sdc(design("quad_divider"), propagated=False))
    (folder / "design.tcl").write_text(variables("Shift", KNOWN, Floor(0.4), files))
    (folder / "report.tcl").write_text(REPORT)
    for stage in ("common", "floorplan", "power", "place", "cts", "report"):
        if stage != "report":
            (folder / f"{stage}.tcl").write_text((SCRIPTS / f"{stage}.tcl").read_text())
        if stage != "common":
            done = finish(openroad.command(f"{stage}.tcl"), cwd=folder, log=folder / f"{stage}.log")
            assert done.returncode == 0, done.stdout
    return folder


def test_every_register_stays_and_the_clock_has_a_tree(folder):
    text = (folder / "cts.v").read_text()
    assert len(re.findall(r"__dfxtp_\d+ r\d+ ", text)) == BITS
    assert 1 <= len(re.findall(r"__clkbuf_\d+ clkbuf", text)) <= 6


def test_a_buffer_halves_the_way_and_drives_the_port(folder):
    procedures, _, _ = (SCRIPTS / "loads.tcl").read_text().partition("\nglobal_route ")
    opened = procedures.replace("open_stage repair", "open_stage cts")
    (folder / "halve.tcl").write_text(f"{opened}\n{HALVE}")
    done = finish(openroad.command("halve.tcl"), cwd=folder, log=folder / "halve.log")
    assert done.returncode == 0, done.stdout
    text = (folder / "halved.v").read_text()
    buffer, inside = (
        {*re.findall(r"\.(\w)\(([^)]*)\)", cell)} for cell in re.findall(r"halfway_\S+ +\(([^;]*);", text)
    )
    assert buffer == {("A", "halfway_y_net"), ("X", "y")} and ".X(halfway_y_net)" in text
    assert {pin for pin, _ in inside} == {"A", "X"} and ("X", "y") not in inside


def test_a_stage_prints_its_figures(folder):
    (density,) = re.findall(r"(?m)^TALBOT placement_density (\S+)$", (folder / "place.log").read_text())
    assert 0.3 < float(density) < 0.8
