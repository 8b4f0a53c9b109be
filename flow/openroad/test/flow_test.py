"""The stages, run in their order by the real Yosys and by a stand-in for OpenROAD; and the SDC by the real OpenSTA."""

import json
import re
import shutil
from dataclasses import replace

import pytest

from talbot.base.command import main
from talbot.base.steps import Runner
from talbot.base.tools import ToolError, finish
from talbot.flow.layout.design import DESIGNS, design
from talbot.flow.layout.steps.library import Library
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.flow.layout.timing.constraints import sdc
from talbot.flow.openroad import command
from talbot.flow.openroad.netlists import write_synthesized
from talbot.flow.openroad.signoff import checks, given
from talbot.flow.openroad.stages import SCRIPTS, TCL_YOSYS, pdk_root, run, stages
from talbot.flow.openroad.test import stub
from talbot.flow.openroad.test.commands import COMMANDS, OLDER
from talbot.flow.openroad.test.librelane_pdk import with_delays
from talbot.flow.openroad.variables import variables
from talbot.flow.openroad.write import write
from talbot.models.parameters import ParameterError
from talbot.platforms.openroad import WIRES, openroad_platform
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


@pytest.fixture
def openroad(tmp_path, monkeypatch):
    """The stand-in ahead on PATH."""
    stub.install(tmp_path)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")


@pytest.fixture(scope="module")
def divider(tmp_path_factory):
    """The divider's files."""
    folder = tmp_path_factory.mktemp("written")
    write(design("quad_divider"), KNOWN, folder)
    return folder


@pytest.fixture
def written(divider, tmp_path, monkeypatch):
    """The divider's files, a netlist in place of Yosys's stage, and the others in no process of their own."""
    monkeypatch.setattr("talbot.flow.openroad.stages.alone", lambda call, *arguments: (call(*arguments), 1))
    monkeypatch.setattr("talbot.flow.openroad.stages.stages", lambda tech, wires: stages(tech, wires)[1:])
    shutil.copytree(divider, tmp_path, dirs_exist_ok=True)
    (tmp_path / "netlist.v").write_text("")
    return design("quad_divider")


def unchecked(design, tech, root, folder, size_um, note):
    """In place of the checks: their inputs alone."""
    runner = Runner(folder / "steps", given(design, tech, root, folder, size_um), note)
    runner.paths |= {"library.liberty": folder / "signoff" / f"{CORNERS[0]}.lib"}
    steps = [Library(PdkParameters(tech.name)), *checks(design, tech)]
    known = runner.paths.keys() | {f"{step.name}.{name}" for step in steps for name in step.outputs}
    assert {source for step in steps for source in step.inputs.values()} <= known
    made = "fill.gds", "drc.report", "lvs.report", *(f"block_liberty_{corner}.liberty" for corner in CORNERS)
    runner.paths |= dict.fromkeys(made, folder / "final.gds")
    return runner


@needs_tclsh
@needs_yosys
@needs_cells
def test_every_stage_runs_with_known_commands_only(pdk, openroad, tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("PDK_ROOT", str(pdk))
    monkeypatch.setattr(command, "check", unchecked)
    assert main(command, ["quad_divider", "--out", str(tmp_path / "out")]) == 1
    assert "equivalence = None: must be proven" in capsys.readouterr().err
    folder = tmp_path / "out" / "quad_divider-openroad"
    summary = json.loads((folder / "summary.json").read_text())
    assert 500 < summary["cells"] < 1200 and summary["cell_area_um2"] > 3000
    assert summary["wns_ns"] == dict.fromkeys(CORNERS, 1.5) and summary["router_drc_violations"] == 0
    assert len(summary["slacks_by_wires"]) == 2 * len(WIRES) * len(CORNERS) and summary["slew_violations"] == 0
    assert re.search(r"sky130_fd_sc_hd__dfxtp_1 \\\S+_reg ", (folder / "netlist.v").read_text())
    assert (folder / "QuadDividerRadix4.sv").read_text().count("module QuadDividerRadix4") == 1
    assert "dfxtp" not in (folder / "QuadDividerRadix4.sv").read_text()  # the RTL is left as it was
    assert summary["area_um2"] == 600
    timed = [f"{corner}.{suffix}" for corner in CORNERS for suffix in ("lib", "sdf")]
    assert {f"quad_divider.{suffix}" for suffix in ("gds", "lef", "v", "spef", "sdc", *timed)} <= {
        path.name for path in folder.iterdir()
    }
    called = [line.split()[0] for line in (folder / "calls.txt").read_text().splitlines()]
    order = [
        "initialize_floorplan",
        "pdngen",
        "place_pins",
        "clock_tree_synthesis",
        "global_route",
        "detailed_route",
        "write_spef",
        "read_spef",
    ]
    assert [called.index(name) for name in order] == sorted(called.index(name) for name in order)
    # Behind all that moves cells far, loads are repaired on global routes between their places
    placed = called[len(called) - called[::-1].index("improve_placement") : called.index("detailed_route")]
    assert "repair_timing" not in placed and placed.index("global_route") < placed.index("repair_design")
    assert called.count("write_db") == 7 and called.count("write_sdf") == len(WIRES) * len(CORNERS)


@needs_tclsh
@pytest.mark.parametrize(
    "line, said",
    [
        ("global_placement -densty 0.5", "unknown option"),
        ("place_pin_s", "invalid command"),
        ("write_def", "arguments"),
        ("read_db nowhere.odb", "no file"),
    ],
)
def test_the_stand_in_refuses_what_openroad_does_not_have(line, said, openroad, tmp_path):
    (tmp_path / "wrong.tcl").write_text(line + "\n")
    done = finish([tmp_path / "openroad", "-exit", "wrong.tcl"], cwd=tmp_path)
    assert done.returncode == 1 and said in done.stderr


@needs_tclsh
@needs_cells
@pytest.mark.parametrize(
    "commands, called, other",
    [
        (COMMANDS, "set_extraction_rules_file", "-ext_model_file"),
        (OLDER, "-ext_model_file", "set_extraction_rules_file"),
    ],
)
def test_older_releases_get_the_options_that_they_want(commands, called, other, pdk, openroad, written, tmp_path):
    stub.install(tmp_path, commands)
    assert run(tmp_path, written.top, KNOWN, pdk, lambda text: None)["router_drc_violations"] == 0
    calls = (tmp_path / "calls.txt").read_text()
    assert called in calls and other not in calls and all(f"{pdk}/{path}" in calls for path in RULES)


@needs_tclsh
@needs_cells
@pytest.mark.parametrize("violations, diodes, routed", [("0", "0", 1), ("1", "0", 1), ("1", "2", 4)])
def test_routes_are_made_again_while_diodes_help_then_fillers(
    violations, diodes, routed, pdk, openroad, written, tmp_path
):
    stub.install(
        tmp_path,
        COMMANDS
        | {
            "check_antennas": replace(COMMANDS["check_antennas"], says=violations),
            "repair_antennas": replace(COMMANDS["repair_antennas"], says=diodes),
        },
    )
    assert run(tmp_path, written.top, KNOWN, pdk, lambda text: None)["router_antennas"] == float(violations)
    called = [line.split()[0] for line in (tmp_path / "calls.txt").read_text().splitlines()]
    assert called.count("detailed_route") == routed
    assert called.index("filler_placement") > max(k for k, name in enumerate(called) if name == "detailed_route")


@needs_tclsh
@needs_cells
def test_a_stage_that_fails_is_named(pdk, openroad, written, tmp_path):
    (tmp_path / "cts.tcl").write_text("clock_tree\n")
    seen = []
    with pytest.raises(ToolError, match='openroad cts: status 1, cts.odb not written:\ninvalid command name "clock_tr'):
        run(tmp_path, written.top, KNOWN, pdk, seen.append)
    assert seen == ["floorplan", "power", "place", "cts"]


@needs_tclsh
@needs_cells
def test_a_stage_runs_again_only_where_its_inputs_changed(pdk, openroad, written, tmp_path):
    calls = tmp_path / "calls.txt"

    def called():
        """Commands of one more run, and its figures."""
        calls.write_text("")
        found = run(tmp_path, written.top, KNOWN, pdk, lambda text: None)
        return [line.split()[0] for line in calls.read_text().splitlines()], found

    every, found = called()
    assert every[:2] == ["read_lef", "read_lef"] and "write_sdf" in every
    assert called() == ([], found)
    script = tmp_path / "route.tcl"
    script.write_text(script.read_text().replace("-congestion_iterations 100", "-congestion_iterations 99"))
    again = called()[0]
    assert "initialize_floorplan" not in again and again.count("write_db") == 1 and "write_sdf" in again
    for name in ("final.v", "finish.json"):
        (tmp_path / name).write_text("damaged")
        assert called()[0].count("write_verilog") == 2
        assert called()[0] == []


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
    assert "set_input_delay 4 " in text and "set_load 0.02 " in text and "set_false_path" not in text


def test_asynchronous_pins_are_not_timed():
    """Those of the chip, and of the block whose synchronizers they pass."""
    assert "set_false_path -from [get_ports {sclk csn mosi reset}]\n" in sdc(design("asp_chip"))
    assert "set_false_path -from [get_ports {sclk csn mosi}]\n" in sdc(design("reg_file"))


@pytest.mark.parametrize("name", DESIGNS)
def test_variables_are_in_range(name):
    text = variables(design(name), KNOWN)
    values = dict(line.split(" ", 2)[1:] for line in text.splitlines() if line.startswith("set "))
    utilization, addon = (float(values[key].strip("{}")) for key in ("utilization", "density_addon"))
    assert 10 <= utilization <= 85 and 0 <= addon <= 0.3


def test_bad_input_is_one_line_and_status_2(tmp_path, monkeypatch, capsys):
    assert main(command, ["divider", "--out", str(tmp_path)]) == 2
    assert main(command, ["quad_divider", "--pdk", "tsmc", "--out", str(tmp_path)]) == 2
    assert main(command, ["asp_chip_macros", "--out", str(tmp_path)]) == 2
    assert list(tmp_path.iterdir()) == []
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 3 and "DESIGN = 'divider'" in lines[0] and "pdk = 'tsmc'" in lines[1]
    assert "without macros" in lines[2]


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


def test_stages_are_the_scripts():
    scripts = {path.name for path in SCRIPTS.glob("*.tcl")}
    assert {f"{stage.name}.tcl" for stage in stages(KNOWN)} | {"common.tcl"} == scripts
