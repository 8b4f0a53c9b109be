"""What is written for a design with a foundry's cells; synthesis by the real Yosys, timing by the real OpenSTA."""

import shutil
from dataclasses import replace

import pytest

from talbot.base.command import main
from talbot.base.tools import finish
from talbot.flow.layout.design import DESIGNS, design
from talbot.flow.layout.steps.stage import SCRIPTS
from talbot.flow.layout.timing.constraints import sdc
from talbot.flow.openroad import command
from talbot.flow.openroad.netlists import write_synthesized
from talbot.flow.openroad.signoff import given
from talbot.flow.openroad.stages import TCL_YOSYS, pdk_root, stages
from talbot.flow.openroad.test.librelane_pdk import with_delays
from talbot.flow.openroad.write import design_tcl
from talbot.models.parameters import ParameterError
from talbot.platforms.openroad import openroad_platform
from talbot.platforms.sky130 import cells as sky130_hd
from talbot.platforms.sky130 import functions

KNOWN = openroad_platform("sky130")
CORNERS = KNOWN.corners
RULES = [paths[-1] for paths in KNOWN.rcx_rules.values()]
SPEF = """*SPEF "IEEE 1481-1998"
*DESIGN "x"
*DATE "x"
*VENDOR "x"
*PROGRAM "x"
*VERSION "x"
*DESIGN_FLOW "x"
*DIVIDER /
*DELIMITER :
*BUS_DELIMITER [ ]
*T_UNIT 1 NS
*C_UNIT 1 PF
*R_UNIT 1 OHM
*L_UNIT 1 HENRY
*D_NET clk 0.01
*END
"""
needs_tclsh = pytest.mark.needs("tclsh")
needs_yosys = pytest.mark.needs("yosys-tcl")
needs_sta = pytest.mark.needs("sta")


needs_cells = pytest.mark.needs("layout")


@pytest.fixture(scope="module")
def pdk(tmp_path_factory):
    """A PDK_ROOT: cells with functions and areas, LEF and GDS of one of them, empty files for the rest."""
    root = tmp_path_factory.mktemp("pdk")
    for path in (*KNOWN.liberty.values(), KNOWN.tech_lef, KNOWN.cell_lef, KNOWN.cell_gds, *RULES):
        (root / path).parent.mkdir(parents=True, exist_ok=True)
        (root / path).write_text("")
    text = with_delays(functions.small_liberty())  # synthesis sizes cells by their delays
    for corner, path in KNOWN.liberty.items():
        (root / path).write_text(text.replace("library (", f"library ({corner}_", 1))
    shutil.copyfile(sky130_hd.folder() / "tech" / "sky130_fd_sc_hd__nom.tlef", root / KNOWN.tech_lef)
    shutil.copyfile(sky130_hd.file("inv_1", "lef"), root / KNOWN.cell_lef)
    shutil.copyfile(sky130_hd.file("inv_1", "gds"), root / KNOWN.cell_gds)
    return root


@needs_tclsh
@pytest.mark.parametrize("script", sorted(path.name for path in SCRIPTS.glob("*.tcl")))
def test_scripts_are_whole_tcl(script, tmp_path):
    (tmp_path / "check.tcl").write_text(f"set f [open {{{SCRIPTS / script}}}]; puts [info complete [read $f]]")
    assert finish(["tclsh", tmp_path / "check.tcl"]).stdout == "1\n"


@needs_sta
@needs_yosys
@needs_cells
def test_constraints_and_timing_script_in_opensta(pdk, tmp_path):
    """The SDC and sta.tcl, run by the real OpenSTA on a netlist of cells without delays."""
    assert main(command, ["quad_divider", "--out", str(tmp_path), "--write-only"]) == 0
    folder = tmp_path / "quad_divider-openroad"
    (folder / "synthesis.lib").write_text(with_delays(functions.small_liberty()))
    done = finish([TCL_YOSYS, "-q", "-c", "synth.tcl"], cwd=folder, env={"PDK_ROOT": str(pdk)})
    assert done.returncode == 0, done.stderr
    write_synthesized(folder, "QuadDividerRadix4", KNOWN)
    (folder / "netlist.v").rename(folder / "final.v")
    (folder / "nom.spef").write_text(SPEF)
    done = finish(
        ["sta", "-no_init", "-no_splash", "-exit", "sta.tcl"], cwd=folder, env={"PDK_ROOT": str(pdk), "CORNER": "nom"}
    )
    said = done.stdout + done.stderr
    errors = [line for line in said.splitlines() if line.startswith(("Error", "Warning"))]
    # OpenSTA 2.0 (Debian's) does not know this option yet, which OpenROAD's does
    assert [line for line in errors if "report_check_types -max_slew" not in line] == []
    assert all(f"TALBOT wns_ns.nom.{corner}" in said for corner in CORNERS)
    assert (folder / f"nom.{CORNERS[0]}.sdf").exists()


@needs_yosys
@needs_cells
def test_models_are_there_for_cells_that_repair_removed(pdk, tmp_path):
    netlist = "module top (a, y); input a; output y; wire b; {} endmodule\n"
    inverter = "sky130_fd_sc_hd__inv_1 {} (.A({}), .Y({}));"
    both = inverter.format("u", "a", "b") + inverter.format("v", "b", "y").replace("inv_1", "inv_2")
    (tmp_path / "netlist.v").write_text(netlist.format(both))
    (tmp_path / "final.v").write_text(netlist.format(inverter.format("u", "a", "y")))
    chosen = replace(design("quad_divider"), top="top")
    models = given(chosen, KNOWN, pdk, tmp_path, (10.0, 10.0))["sdc"].with_name("cells.v").read_text()
    assert all(f"module sky130_fd_sc_hd__inv_{size}(" in models for size in (1, 2))


def test_sdc_says_what_the_design_says():
    text = sdc(design("quad_divider"), propagated=False)
    assert "create_clock -name clk -period 20 " in text and "set_propagated_clock" not in text
    assert "set_propagated_clock" in sdc(design("quad_divider"))
    assert (
        "set_input_delay -max 4 " in text
        and "set_input_delay -min 1 " in text
        and "set_load 0.02 " in text
        and "set_false_path" not in text
    )


def test_asynchronous_pins_are_not_timed():
    """Those of the chip, and of the block whose synchronizers they pass."""
    assert "set_false_path -from [get_ports {sclk csn mosi reset}]\n" in sdc(design("asp_chip"))
    assert "set_false_path -from [get_ports {sclk csn mosi}]\n" in sdc(design("reg_file"))


@pytest.mark.parametrize("name", DESIGNS)
def test_variables_are_in_range(name):
    text = design_tcl(design(name), KNOWN)
    values = dict(line.split(" ", 2)[1:] for line in text.splitlines() if line.startswith("set "))
    utilization, addon = (float(values[key].strip("{}")) for key in ("utilization", "density_addon"))
    assert 10 <= utilization <= 85 and 0 <= addon <= 0.3


def test_bad_input_is_one_line_and_status_2(tmp_path, monkeypatch, capsys):
    assert main(command, ["divider", "--out", str(tmp_path)]) == 2
    assert main(command, ["quad_divider", "--pdk", "tsmc", "--out", str(tmp_path)]) == 2
    assert main(command, ["tt_amp_ctrl", "--out", str(tmp_path)]) == 2
    assert list(tmp_path.iterdir()) == []
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 3 and "DESIGN = 'divider'" in lines[0] and "pdk = 'tsmc'" in lines[1]
    assert "without a frame" in lines[2]


def test_without_openroad_it_says_where_to_get_it_and_what_was_written(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(command, "missing_tools", lambda: ["openroad"])
    assert main(command, ["amp_ctrl", "--out", str(tmp_path)]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1 and "openroad: not found; make setup-layout" in error and "floorplan.tcl" in error
    assert (tmp_path / "amp_ctrl-openroad" / "floorplan.tcl").is_file()


def test_a_pdk_that_lacks_a_file_is_named(tmp_path):
    with pytest.raises(ParameterError, match="PDK_ROOT = '': must be the folder"):
        pdk_root(KNOWN, {})
    with pytest.raises(ParameterError, match="must hold sky130A/libs.ref"):
        pdk_root(KNOWN, {"PDK_ROOT": str(tmp_path)})


def test_a_pdk_may_name_its_extraction_rules_folder_as_it_did_before_2025(tmp_path):
    for path in (*KNOWN.liberty.values(), KNOWN.tech_lef, KNOWN.cell_lef, KNOWN.cell_gds):
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text("")
    with pytest.raises(ParameterError, match="must hold .*/librelane/rules.*nom.calibre or .*/openlane/rules"):
        pdk_root(KNOWN, {"PDK_ROOT": str(tmp_path)})
    older = tmp_path / RULES[0]
    older.parent.mkdir(parents=True)
    older.write_text("")
    assert pdk_root(KNOWN, {"PDK_ROOT": str(tmp_path)}) == tmp_path


def test_stages_are_the_scripts_but_for_thresholds_that_these_cells_do_not_have():
    scripts = {path.name for path in SCRIPTS.glob("*.tcl")}
    assert {f"{stage.name}.tcl" for stage in stages(KNOWN)} | {"common.tcl"} == scripts - {"thresholds.tcl"}
