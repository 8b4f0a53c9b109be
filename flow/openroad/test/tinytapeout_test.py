"""The Tiny Tapeout projects: their files as its tools check them, their netlists of sky130_fd_sc_hd from their pins."""

import json
import re
import sys
from functools import cache

import pytest
import yaml

from talbot.base.paths import ROOT
from talbot.base.tools import finish, run
from talbot.flow.layout.design import design
from talbot.flow.openroad.tinytapeout import PROJECTS, Project, project_files
from talbot.flow.openroad.write import rtl
from talbot.models.parameters import ParameterError
from talbot.platforms.sky130 import cells as sky130_hd
from talbot.platforms.sky130 import functions
from talbot.platforms.sky130.tinytapeout import FRAME, FULL, SIZES_UM

TOPS = ROOT / "rtl" / "tinytapeout"
MARGIN_SITES, MARGIN_ROWS = 12, 2
SCRIPT = """
read_verilog -sv {top}.sv
synth -flatten -top {top}
delete t:$scopeinfo
check -assert
dfflibmap -liberty cells.lib
abc -liberty cells.lib
setundef -zero
hilomap -singleton -hicell {constant} HI -locell {constant} LO
splitnets
opt_clean -purge
tee -q -o stat.txt stat -liberty cells.lib
write_verilog -noattr -noexpr netlist.v
"""


pytestmark = pytest.mark.needs("iverilog", "yosys", "layout")


@pytest.fixture(scope="module")
def synthesized(tmp_path_factory):
    """Return the function from a project's name to its netlist's path and its cells' area in um2, by Yosys."""

    def synthesize(name):
        chosen, folder = design(name), tmp_path_factory.mktemp(name)
        rtl(chosen, folder)
        (folder / "cells.lib").write_text(functions.small_liberty())
        constant = f"{sky130_hd.LIBRARY}__{functions.CONSTANT}"
        (folder / "synthesis.ys").write_text(SCRIPT.format(top=chosen.top, constant=constant))
        run(["yosys", "-q", "-s", "synthesis.ys"], cwd=folder)
        area = re.search(r"Chip area for (?:top )?module[^:]*:\s+([\d.]+)", (folder / "stat.txt").read_text())
        return folder / "netlist.v", float(area[1])

    return cache(synthesize)


def core_um2(tiles):
    """Return the area for cells in ``tiles`` tiles."""
    width, height = SIZES_UM[tiles]
    site = sky130_hd.SITE
    columns, rows = round(width / site.width_um) - MARGIN_SITES, round(height / site.height_um) - MARGIN_ROWS
    return columns * site.width_um * rows * site.height_um


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """files(name): those of the project."""

    def export(name):
        chosen = design(name)
        return project_files(chosen, rtl(chosen, tmp_path_factory.mktemp(name)))

    return cache(export)


@pytest.mark.slow
@pytest.mark.parametrize("name", PROJECTS)
def test_its_netlist_passes_the_tests_from_its_pins(name, synthesized):
    netlist, top = synthesized(name)[0], design(name).top
    cells = sorted(set(re.findall(rf"(?m)^\s+{sky130_hd.LIBRARY}__(\w+) ", netlist.read_text())))
    models = netlist.with_name("cells.v")
    text = "".join(sky130_hd.file(cell, "functional.v").read_text() for cell in cells)
    models.write_text(text.replace('`include "../..', f'`include "{sky130_hd.folder()}'))
    command = [sys.executable, "-m", "pytest", "rtl/tinytapeout", "-p", "no:xdist", f"--netlist={top}={netlist}"]
    done = finish([*command, f"--cells={models}"], cwd=ROOT)
    assert not done.returncode and re.search(r"[12] passed", done.stdout), done.stdout[-2000:]


@pytest.mark.slow
@pytest.mark.parametrize("name", PROJECTS)
def test_it_fits_its_tiles(name, synthesized):
    assert 0.1 < synthesized(name)[1] / core_um2(design(name).frame.removeprefix(FRAME)) < FULL


def test_room_of_a_tile():
    assert core_um2("1x1") == pytest.approx(338 * 0.46 * 39 * 2.72)  # ROWs of its DEF template


@pytest.mark.parametrize("name", PROJECTS)
def test_the_files_pass_the_checks_of_tiny_tapeouts_tools(name, files):
    made = files(name)
    info = yaml.safe_load(made["tinytapeout/info.yaml"])
    project = info["project"]
    assert info["yaml_version"] == 6 and project["top_module"].startswith("tt_um_")
    assert project["tiles"] in SIZES_UM
    assert all(project[key] for key in ("title", "author", "description", "language", "source_files"))
    assert isinstance(project["clock_hz"], int)
    assert set(info["pinout"]) == {f"{bank}[{k}]" for bank in ("ui", "uo", "uio") for k in range(8)}
    assert {f"tinytapeout/src/{file}" for file in project["source_files"]} <= set(made)
    assert json.loads(made["tinytapeout/src/config.json"])["CLOCK_PERIOD"] == design(name).clock.period_ns
    page = made["tinytapeout/docs/info.md"]
    assert "PyMTL" not in page
    own = [
        file for file in TOPS.glob("*.v") if f"module {file.stem}\n" in made[f"tinytapeout/src/{design(name).top}.sv"]
    ]
    assert TOPS / f"{project['top_module']}.v" in own
    for file in own:  # the comment at the head of each
        assert file.read_text().splitlines()[0].removeprefix("// ") in page


@pytest.mark.parametrize("name", PROJECTS)
def test_its_ports_are_those_of_every_tile_and_its_top_is_found_once(name, files, tmp_path):
    """As tt-support-tools' check_ports and find_top_verilog do it."""
    top = design(name).top
    verilog = files(name)[f"tinytapeout/src/{top}.sv"]
    (tmp_path / "top.v").write_text(verilog)
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
    assert re.findall(r"(?:^|\s)module\s+(\w+)", verilog).count(top) == 1


def test_a_project_checks_itself():
    with pytest.raises(ParameterError, match="ui = 1 pins"):
        Project(**vars(PROJECTS["tt_amp_ctrl"]) | {"ui": ("a",)})
