"""A cell from GDS to Liberty, with the tools that read it."""

import json
import subprocess

import numpy as np
import pytest

from talbot.base.command import main
from talbot.base.liberty.read import read
from talbot.cells import command, sources
from talbot.cells.characterize.conditions import Conditions
from talbot.cells.corner import Corner
from talbot.cells.liberty.check import problems
from talbot.models.parameters import ParameterError

ready = pytest.mark.needs("ngspice", "layout")


CONDITION_SLEWS = 1e9 * np.array(Conditions(Corner("tt", 25, 1.8)).slews)
SWAPPED = """.subckt myinv A Y VPWR VGND
X0 Y A VGND VPWR sky130_fd_pr__pfet_01v8_hvt w=1.0 l=0.15
X1 Y A VPWR VGND sky130_fd_pr__nfet_01v8 w=0.65 l=0.15
.ends
"""


def make(folder, *arguments):
    """The library of `talbot cells` with ``arguments``, and its path."""
    assert main(command, ["--out", str(folder), "--workers", "1", *arguments]) == 0
    path = next(folder.glob("sky130_hd/*.lib"))
    return read(path), path


@pytest.mark.parametrize(
    "name, values",
    [("tt_025C_1v80", ("tt", 25, 1.8)), ("ff_n40C_1v95", ("ff", -40, 1.95)), ("ss_100C_1v60", ("ss", 100, 1.6))],
)
def test_corners_have_names(name, values):
    corner = Corner.parse(name)
    assert (corner.process, corner.temperature, corner.supply) == values and corner.name == name


@pytest.mark.parametrize("name", ["tt", "xx_025C_1v80", "tt_25_1v80", "tt_900C_1v80"])
def test_other_names_are_refused(name):
    with pytest.raises(ParameterError, match="corner|temperature"):
        Corner.parse(name)


@pytest.fixture(scope="module")
def gates(tmp_path_factory):
    return make(tmp_path_factory.mktemp("cells"), "--cells", "inv_1,nand2_1")


@ready
def test_a_library_has_what_it_must(gates):
    library, _ = gates
    assert problems(library) == []
    cell = library.one("cell", "sky130_fd_sc_hd__nand2_1")
    assert cell.attributes["area"] == pytest.approx(3.7536) and len(cell.all("leakage_power")) == 4
    table = cell.one("pin", "Y").all("timing", related_pin="A")[0].one("cell_fall")
    assert table.array("values").shape == (len(table.array("index_1")), len(table.array("index_2")))
    assert min(table.array("values").shape) >= 7 and set(np.round(CONDITION_SLEWS, 6)) <= set(
        np.round(table.array("index_1"), 6)
    )
    slews = cell.one("pin", "Y").all("timing", related_pin="A")[0].one("rise_transition").array("values")
    assert slews[-1, -1] == pytest.approx(1.5, rel=0.05)  # the axis ends where the slew does


@ready
def test_every_pin_has_the_limits_that_its_tables_cover(gates):
    library, _ = gates
    for pin in library.one("cell", "sky130_fd_sc_hd__nand2_1").all("pin"):
        assert pin.number("max_transition") == pytest.approx(1.5)
    pin = library.one("cell", "sky130_fd_sc_hd__nand2_1").one("pin", "Y")
    table = pin.all("timing", related_pin="A")[0].one("cell_fall")
    assert pin.number("max_capacitance") == pytest.approx(table.array("index_2")[-1])


@ready
def test_a_slow_corner_has_its_leakage_and_tables_beyond_its_limits(tmp_path):
    """Published for inv_1 at ss_100C_1v60: 4.03 nW, slews to 5 ns, the limits still at 1.5 ns."""
    library, _ = make(tmp_path, "--cells", "inv_1", "--corners", "ss_100C_1v60")
    cell = library.one("cell", "sky130_fd_sc_hd__inv_1")
    assert cell.number("cell_leakage_power") == pytest.approx(4.03, rel=0.25)
    pin = cell.one("pin", "Y")
    table = pin.all("timing")[0].one("rise_transition")
    loads, limit = table.array("index_2"), pin.number("max_capacitance")
    assert table.array("index_1")[-1] == pytest.approx(5) and loads[-1] > 2 * limit
    assert pin.number("max_transition") == pytest.approx(1.5)


@ready
def test_the_checker_sees_what_was_taken_away(gates):
    library, path = gates
    broken = read(path)
    pin = broken.one("cell", "sky130_fd_sc_hd__nand2_1").one("pin", "Y")
    pin.groups.remove(pin.all("timing", related_pin="B")[0])
    table = pin.all("timing", related_pin="A")[0].one("cell_fall")
    table.attributes["values"] = np.flip(table.array("values"), axis=1)
    assert [text.split(": ", 1)[1] for text in problems(broken)] == [
        "Y has no arc from B",
        "Y from A: cell_fall falls with the load",
    ]


@ready
@pytest.mark.needs("yosys")
def test_yosys_reads_it_without_a_warning(gates):
    _, path = gates
    _silent(["yosys", "-q", "-p", f"read_liberty {path}; check -assert"])


@ready
@pytest.mark.needs("sta")
def test_opensta_reads_it_without_a_warning(gates, tmp_path):
    _, path = gates
    _silent(_sta(path, tmp_path))


@ready
@pytest.mark.slow
@pytest.mark.timeout(1200)
@pytest.mark.needs("sta", "yosys")
def test_storage_and_tri_state_are_read_too(tmp_path):
    library, path = make(tmp_path, "--cells", "dfrtp_1,dlxtn_1,dlclkp_1,ebufn_1")
    assert problems(library) == []
    _silent(["yosys", "-q", "-p", f"read_liberty {path}"])
    _silent(_sta(path, tmp_path))


@ready
def test_every_cell_is_characterized_or_left_out_with_a_reason():
    taken, out = set(sources.names("sky130_hd")), sources.left_out("sky130_hd")
    assert len(taken) == 384 and not taken & set(out) and all(out.values())
    assert {"nand2_1", "sdfbbn_1", "einvn_0", "sdlclkp_4", "mux4_1"} <= taken
    assert {"tap_1", "conb_1", "diode_2", "lpflow_bleeder_1", "macro_sparecell"} <= set(out)
    assert sources.left_out("compact").keys() >= {"one_x1", "zero_x1", "tie"}


@ready
def test_an_unknown_cell_is_refused(tmp_path, capsys):
    assert main(command, ["--cells", "nand2_1,nope_1", "--out", str(tmp_path)]) == 2
    assert "cells = nope_1: must be of sky130_hd" in capsys.readouterr().err


OWN = """* a user's cells
.subckt myinv A Y VPWR VGND
X0 Y A VGND VGND sky130_fd_pr__nfet_01v8 w=0.65 l=0.15
X1 Y A VPWR VPWR sky130_fd_pr__pfet_01v8_hvt w=1.0 l=0.15
.ends
.subckt other A Y VPWR VGND
X0 Y A VGND VGND sky130_fd_pr__nfet_01v8 w=0.42 l=0.15
X1 Y A VPWR VPWR sky130_fd_pr__pfet_01v8_hvt w=0.64 l=0.15
.ends
"""


@ready
def test_a_netlist_of_ones_own_becomes_a_library(tmp_path):
    (tmp_path / "mine.sp").write_text(OWN)
    arguments = ["--lib", str(tmp_path / "mine.sp"), "--out", str(tmp_path), "--workers", "1", "--cells", "myinv"]
    assert main(command, arguments) == 0
    library = read(tmp_path / "mine" / "tt_025C_1v80.lib")
    assert [cell.name for cell in library.all("cell")] == ["myinv"] and problems(library) == []
    assert main(command, [*arguments[:-1], "other", "--corners", "ff_025C_1v95"]) == 0
    summary = json.loads((tmp_path / "mine" / "summary.json").read_text())
    assert summary["corner"] == "ff_025C_1v95" and set(summary["corners"]) == {"tt_025C_1v80", "ff_025C_1v95"}
    assert summary["corners"]["tt_025C_1v80"]["names"] == ["myinv"] and summary["names"] == ["other"]


@ready
@pytest.mark.parametrize(
    "old, new, why",
    [
        ("X1 Y A VPWR", "X1 Y Q VPWR", "netlist = myinv: the gate of X1 is floating: nothing drives node Q"),
        ("sky130_fd_pr__pfet_01v8_hvt", "pmos", "netlist = myinv: transistor X1 has model pmos, which the process"),
        ("myinv A Y", "myinv A Y B", "netlist = myinv: port B is connected to nothing"),
        ("VPWR", "POWER", "netlist = myinv: port VPWR or VPB or vdd is missing; it has A, Y, POWER, VGND"),
        ("w=0.65", "w=0.65u", "netlist = myinv: model = sky130_fd_pr__nfet_01v8: has no model for w and l"),
        ("X0 Y A VGND VGND sky", "D0 Y A sky", "is no transistor, capacitor or resistor"),
        ("X1 Y A VPWR", "X1 Z A VPWR", "netlist = myinv: has no output, a port that it drives to both levels"),
        ("w=0.65", "", "netlist = myinv: transistor X0 must have w and l above 0"),
        (" VPWR VPWR sky", " VPWR VPWR m2 sky", "must be a transistor: drain gate source bulk model"),
        (".ends", "", ".subckt myinv has no .ends"),
        (".subckt", "*", "has no .subckt"),
    ],
)
def test_a_wrong_netlist_is_refused_before_anything_runs(tmp_path, capsys, old, new, why):
    (tmp_path / "mine.sp").write_text(OWN[: OWN.index(".subckt other")].replace(old, new))
    assert main(command, ["--lib", str(tmp_path / "mine.sp"), "--out", str(tmp_path), "--workers", "1"]) == 2
    assert why in capsys.readouterr().err
    assert not (tmp_path / "mine").exists()


@ready
def test_a_cell_that_never_reaches_its_level_is_reported_with_its_netlist(tmp_path, capsys):
    """An n transistor pulls up and a p transistor down: a buffer as switches, and short of both levels."""
    (tmp_path / "mine.sp").write_text(SWAPPED)
    assert main(command, ["--lib", str(tmp_path / "mine.sp"), "--out", str(tmp_path), "--workers", "1"]) == 1
    summary = json.loads((tmp_path / "mine" / "summary.json").read_text())
    assert summary["failed"] == ["myinv: Y: axes: myinv: Y does not reach its level after A changes"]
    assert "myinv: Y has no arc from A" in summary["problems"]
    assert ".tran" in (tmp_path / "mine" / "failed" / "tt_025C_1v80" / "myinv.0.sp").read_text()


@ready
def test_a_file_that_is_no_text_is_refused(tmp_path, capsys):
    (tmp_path / "mine.sp").write_bytes(bytes(range(256)))
    assert main(command, ["--lib", str(tmp_path / "mine.sp"), "--out", str(tmp_path), "--workers", "1"]) == 2
    assert "mine.sp: has no .subckt" in capsys.readouterr().err


@ready
def test_the_abstracts_are_what_a_lef_reader_takes(gates):
    _, path = gates
    import klayout.db as db

    layout = db.Layout()
    layout.read(str(path.parent / "sky130_hd.lef"))
    assert {cell.name.split("__")[1] for cell in layout.each_cell()} == {"inv_1", "nand2_1", "conb_1"}
    assert (
        "SITE unithd\n  CLASS CORE ;\n  SYMMETRY Y ;\n  SIZE 0.460 BY 2.720 ;"
        in (path.parent / "sky130_hd.lef").read_text()
    )


def _sta(path, folder):
    script = folder / "read.tcl"
    script.write_text(f"read_liberty {path}\nexit\n")
    return ["sta", "-no_splash", "-exit", str(script)]


def _silent(command):
    result = subprocess.run(command, capture_output=True, text=True, timeout=400, check=False)
    assert (result.returncode, result.stdout.strip(), result.stderr.strip()) == (0, "", "")


def test_the_command_ends_with_its_files(tmp_path, monkeypatch, capsys):
    def written(library, conditions, names, netlist, out, reference, workers):
        folder = out / command.sources.title(library)
        folder.mkdir()
        for name in (f"{conditions.corner.name}.lib", "a.lef", "summary.json"):
            (folder / name).write_text("")
        return {"failed": [], "problems": []}

    monkeypatch.setattr(command, "characterize_library", written)
    assert main(command, ["--out", str(tmp_path)]) == 0
    folder = tmp_path / command.sources.title("sky130_hd")
    assert capsys.readouterr().out.endswith(f"\n{folder}: a.lef, summary.json, tt_025C_1v80.lib\n")
