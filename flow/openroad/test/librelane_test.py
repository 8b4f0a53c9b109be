"""LibreLane itself loads the designs, and runs its steps up to the first that needs OpenROAD."""

import json
from pathlib import Path

import pytest

from talbot.base.command import main
from talbot.base.paths import ROOT
from talbot.base.tools import finish
from talbot.flow.layout.design import design
from talbot.flow.openroad import command
from talbot.flow.openroad.test import librelane_pdk
from talbot.flow.openroad.tinytapeout import PROJECTS
from talbot.platforms.sky130.tinytapeout import FRAME, SIZES_UM

PYTHON = ROOT / "build" / "librelane" / "bin" / "python"
RUN = Path(__file__).parent / "librelane_run.py"
# LibreLane calls `yosys -y SCRIPT OPTIONS -- ARGUMENTS`, which only a Yosys built with Python has; the wheel is one
YOSYS = """#!/bin/sh
script="$2"
while [ "$1" != -- ]; do shift; done
shift
exec {python} "$script" "$@"
"""


pytestmark = pytest.mark.needs("librelane", "layout")


@pytest.fixture(scope="module")
def pdk(tmp_path_factory):
    root = tmp_path_factory.mktemp("pdk")
    librelane_pdk.make(root)
    return root


@pytest.fixture
def written(tmp_path):
    """written(name): the folder with the files of design ``name``."""

    def write(name):
        assert main(command, [name, "--out", str(tmp_path), "--write-only"]) == 0
        return tmp_path / f"{name}-openroad"

    return write


def librelane(config, pdk, *last, env=None):
    """(messages, what the last line says) or, where it fails, (messages, None)."""
    done = finish([PYTHON, RUN, config, pdk, *last], cwd=config.parent, env={"COLUMNS": "1000", **(env or {})})
    *messages, said = done.stdout.splitlines() or [""]
    text = "\n".join([*messages, done.stderr])
    return (text, json.loads(said)) if done.returncode == 0 else (f"{text}\n{said}", None)


@pytest.mark.parametrize("name", ["quad_divider", "amp_ctrl", pytest.param("asp_chip", marks=pytest.mark.slow)])
def test_a_design_loads_without_a_warning(name, written, pdk):
    chosen, folder = design(name), written(name) / "librelane"
    messages, loaded = librelane(folder / "config.yaml", pdk)
    assert loaded and "WARNING" not in messages, messages
    assert loaded["DESIGN_NAME"] == chosen.top and float(loaded["CLOCK_PERIOD"]) == chosen.clock.period_ns
    assert Path(loaded["PNR_SDC_FILE"]) == folder / "pnr.sdc" and loaded["FP_SIZING"] == "relative"


@pytest.mark.parametrize(
    "right, wrong, said",
    [
        ("FP_CORE_UTIL:", "FP_CORE_UTILL:", "Unknown key 'FP_CORE_UTILL'"),
        ("FP_ASPECT_RATIO: 1", "FP_ASPECT_RATIO: wide", "is invalid: 'wide'"),
        ("dir::AmpCtrl.sv", "dir::nowhere.v", "does not exist"),
        ("PL_TARGET_DENSITY_PCT:", "PL_TARGET_DENSITY:", "is deprecated"),
    ],
)
def test_a_wrong_variable_would_be_found(right, wrong, said, written, pdk):
    config = written("amp_ctrl") / "librelane" / "config.yaml"
    config.write_text(config.read_text().replace(right, wrong))
    assert said in librelane(config, pdk)[0]


@pytest.mark.parametrize("name", PROJECTS)
def test_a_tiny_tapeout_project_loads_with_what_its_tools_add(name, written, pdk):
    """Its template's names for four variables are old ones in LibreLane 3, which says so and takes them."""
    source, project = written(name.removeprefix(FRAME)) / "tinytapeout" / "src", design(name)
    files = sorted(path.name for path in source.glob("*.*v"))
    config = source / "config_merged.json"
    config.write_text(
        json.dumps(
            {
                "meta": {"version": 2},
                **json.loads((source / "config.json").read_text()),
                "DESIGN_NAME": project.top,
                "VERILOG_FILES": [f"dir::{file}" for file in files],
                "DIE_AREA": [0, 0, *SIZES_UM[project.frame.removeprefix(FRAME)]],
            }
        )
    )
    messages, loaded = librelane(config, pdk)
    assert loaded and messages.count("WARNING") == messages.count("is deprecated") == 4, messages
    assert (loaded["PDN_VPITCH"], loaded["RT_MAX_LAYER"], loaded["RUN_LINTER"]) == ("38.87", "met4", True)


@pytest.mark.slow
@pytest.mark.needs("verilator")
@pytest.mark.parametrize("name", ["quad_divider", "amp_ctrl"])
def test_its_steps_before_openroad_run(name, written, pdk, tmp_path):
    """Verilator.Lint, Yosys.Synthesis, their checkers, OpenROAD.CheckSDCFiles, OpenROAD.CheckMacroInstances."""
    yosys = tmp_path / "yosys"
    yosys.write_text(YOSYS.format(python=PYTHON))
    yosys.chmod(0o755)
    config = written(name) / "librelane" / "config.yaml"
    messages, metrics = librelane(config, pdk, "OpenROAD.CheckMacroInstances", env={"_LLN_OVERRIDE_YOSYS": str(yosys)})
    assert metrics, messages[-2000:]
    assert 300 < metrics["design__instance__count"] < 2000
    assert [
        metrics[key]
        for key in (
            "design__lint_error__count",
            "design__inferred_latch__count",
            "design__instance_unmapped__count",
            "synthesis__check_error__count",
        )
    ] == [0] * 4
    top = design(name).top
    netlist = (config.parent / "runs" / "test" / "final" / "nl" / f"{top}.nl.v").read_text()
    assert f"module {top}" in netlist and "sky130_fd_sc_hd__dfxtp_1" in netlist
