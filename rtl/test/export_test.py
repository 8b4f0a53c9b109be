"""Exported Verilog: the same bytes from run to run and place to place, accepted by the tools that read it."""

import os
import re
import subprocess
import sys

import pytest

from base.command import main
from base.paths import ROOT
from models.parameters import ArrayParameters, ChipParameters, ParameterError, SensorParameters
from rtl import export
from rtl.export import translate
from rtl.harness.translate import tidy
from rtl.lint import LintError, lint
from rtl.tops import TOPS

SMALL = SensorParameters(array=ArrayParameters(9, 20), chip=ChipParameters(lanes=2))


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    """Every top of the default sensor in one folder, from its own process with another hash seed and width."""
    out = tmp_path_factory.mktemp("exported")
    subprocess.run(
        [sys.executable, "-m", "rtl.export", "--out", out],
        cwd=ROOT,
        check=True,
        capture_output=True,
        env=dict(os.environ, PYTHONHASHSEED="7", COLUMNS="40"),
    )
    return out


@pytest.mark.parametrize("name", TOPS)
def test_the_same_bytes_every_time(exported, name):
    text = (exported / f"{name}.v").read_text()
    assert text == translate(name, SensorParameters())
    assert str(ROOT) not in text and "site-packages" not in text


@pytest.mark.parametrize("name", TOPS)
def test_readable_names_and_flat_ports(exported, name):
    text = (exported / f"{name}.v").read_text()
    modules = re.findall(r"(?m)^module (\w+)", text)
    assert modules[-1] == name and len(set(modules)) == len(modules)
    assert not [m for m in modules + re.findall(r"(?m)^} (\w+);", text) if "__" in m]
    assert not re.findall(r"(?m)^\s*(?:input|output)\b.*\[\d+:\d+\]\s*,?$", text), "an unpacked-array port"


@pytest.mark.parametrize("name", TOPS)
def test_lint_clean(exported, name):
    assert "Verilator clean" in lint(exported / f"{name}.v", name)


def test_lint_finds_what_is_wrong(tmp_path):
    path = tmp_path / "Wide.v"
    path.write_text("module Wide (input logic [7:0] a, output logic [3:0] b);\n  assign b = a;\nendmodule\n")
    with pytest.raises(LintError, match="WIDTHTRUNC"):
        lint(path, "Wide")


def test_files_are_written_atomically(tmp_path, capsys):
    assert main(export, ["--top", "RegFile", "--out", str(tmp_path), "--rows", "9"]) == 0
    assert [p.name for p in tmp_path.iterdir()] == ["RegFile.v"]
    assert (tmp_path / "RegFile.v").read_text() == translate("RegFile", SensorParameters(array=ArrayParameters(9, 384)))
    assert main(export, ["--top", "RegFile", "--out", str(tmp_path), "--lanes", "3"]) == 2
    assert "lanes = 3: must be one of" in capsys.readouterr().err
    assert [p.name for p in tmp_path.iterdir()] == ["RegFile.v"]


def test_unknown_top():
    with pytest.raises(ParameterError, match="top = 'Nothing'"):
        translate("Nothing", SMALL)


def test_tidy_keeps_two_types_of_one_name_apart():
    a = "typedef struct packed {\n  logic [1:0] kind;\n} Msg__kind_2;\nMsg__kind_2 x;\n"
    b = a.replace("kind_2", "0123456789abcdef")
    assert tidy(a + b) == a + b
    assert tidy(b) == tidy(a) == a.replace("__kind_2", "")


def test_tidy_drops_constants_that_nothing_uses():
    width = "  localparam logic [1:0] width  = 2'd1;\n"
    a = f"module A;\n  localparam logic [1:0] used  = 2'd1;\n{width}  x = used;\nendmodule\n"
    b = a.replace("module A", "module B", 1)
    assert tidy(a + b) == (a + b).replace(width, "")
