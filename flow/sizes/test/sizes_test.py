"""Sizes: known circuits count what they must, a missing tool is named."""

import json

import pytest

from talbot.base.command import main
from talbot.base.tools import ToolError
from talbot.flow.sizes import command
from talbot.flow.sizes.measure import areas, measure

needs_yosys = pytest.mark.needs("yosys")

KNOWN = """
module Known (input clk, input a, input b, output reg q, output y);
  assign y = ~(a & b);
  always @(posedge clk) q <= y;
endmodule
"""


@needs_yosys
def test_known_circuit(tmp_path):
    path = tmp_path / "Known.v"
    path.write_text(KNOWN)
    size = measure(path, "Known")
    assert size.by_type == {"DFF": 1, "NAND2": 1}
    assert (size.cells, size.flip_flops, size.gates, size.flip_flop_gates) == (2, 1, 7.0, 6.0)


@needs_yosys
def test_refused_file(tmp_path):
    path = tmp_path / "Bad.v"
    path.write_text("module Bad (input a\n")
    with pytest.raises(ToolError, match="yosys refused"):
        measure(path, "Bad")


@needs_yosys
def test_command_writes_both_files(tmp_path, capsys):
    assert main(command, ["EdgeAdc", "--out", str(tmp_path), "--rows", "8"]) == 0
    (size,) = json.loads((tmp_path / "sizes.json").read_text())
    assert size["top"] == "EdgeAdc"
    assert size["cells"] == sum(size["by_type"].values())
    assert size["gates"] == sum(areas()[cell] * n for cell, n in size["by_type"].items())
    assert "| EdgeAdc |" in (tmp_path / "sizes.md").read_text() and "| EdgeAdc |" in capsys.readouterr().out


def test_missing_yosys(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("talbot.flow.sizes.measure.located", lambda name: None)
    assert main(command, ["RegFile", "--out", str(tmp_path / "out")]) == 2
    assert "yosys: not found; make setup installs it" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    "words, said",
    [
        ("RegFile --lanes=3", "error: lanes = 3: must be one of"),
        ("--rows=-5", "error: rows = -5: must be an integer in 1..1024"),
        ("--rows=x", "error: rows = 'x': must be an integer in 1..1024"),
        ("RegFil", "did you mean RegFile?"),
    ],
)
def test_what_is_wrong_is_said_in_one_line(words, said, tmp_path, capsys):
    try:
        status = main(command, [*words.split(), "--out", str(tmp_path / "out")])
    except SystemExit as stop:
        status = stop.code
    err = capsys.readouterr().err
    assert status == 2 and said in err and err.count("\n") == 1 and "python" not in err
