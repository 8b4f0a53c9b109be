"""Bad input is reported in one line, with exit status 2, and leaves nothing under a final name."""

import lzma
import shutil
import subprocess
from dataclasses import replace

import pytest

from talbot.base.command import main, one_line
from talbot.base.liberty.read import read
from talbot.base.steps import versions
from talbot.flow.layout import chain, command, search, tables
from talbot.flow.layout.options import Options
from talbot.models.parameters import ParameterError
from talbot.signoff.netlist.test import shift_register as small


def reported(capsys, arguments):
    """The one line that `flow.layout` prints, its status being 2."""
    assert main(command, list(map(str, arguments))) == 2
    out, err = capsys.readouterr()
    (line,) = [line for line in err.splitlines() if not line.startswith("\r")] or [""]
    assert not out and line.startswith("flow.layout: ")
    return line


@pytest.mark.parametrize(
    "arguments, words",
    [
        (["nope"], "DESIGN = 'nope': must be one of amp_ctrl"),
        (["quad_divider", "--pdk", "gf180"], "pdk = 'gf180': must be one of sky130"),
        (["quad_divider", "--utilization", "1.2"], "utilization = 1.2: must be"),
        (["quad_divider", "--utilization", "0"], "utilization = 0.0: must be"),
        (["quad_divider", "--utilization", "nan"], "utilization = nan: must be"),
        (["quad_divider", "--liberty", "nowhere.lib"], "liberty = nowhere.lib: no such file"),
        (["quad_divider", "--analog", "mine"], "must be with DESIGN=asp_sensor alone"),
        (["asp_sensor", "--pdk", "ihp-sg13g2"], "pdk = 'ihp-sg13g2': must be one of sky130 for OpenROAD"),
    ],
)
def test_bad_arguments(capsys, tmp_path, arguments, words):
    assert words in reported(capsys, [*arguments, "--out", tmp_path / "out"])
    assert not list(tmp_path.rglob("*"))


def test_a_file_that_is_no_liberty(tmp_path):
    (tmp_path / "x.lib").write_text("module x; endmodule\n")
    with pytest.raises(ParameterError, match="x.lib: must be a Liberty file"):
        Options(liberty=(tmp_path / "x.lib",))
    (tmp_path / "x.lib").write_text("/* made */\n" + small.liberty(), encoding="utf-8")
    with pytest.raises(ParameterError, match=r"must have the cells .* on sky130 .*: has buf_x\d.*lacks .*others"):
        Options(liberty=(tmp_path / "x.lib",))


def test_a_liberty_of_its_cells_as_others_write_them(tmp_path):
    """A byte order mark, Latin-1, lines of Windows, a semicolon after a group; a name with a space."""
    text = lzma.decompress((tables.SHIPPED / "sky130.tt_025C_1v80.lib.xz").read_bytes()).decode()
    path = tmp_path / "my cells (2).lib"
    for data in (f"\ufeff{text}".encode(), text.replace("{\n", "{ /* \u00b5m */\n", 1).encode("latin-1")):
        path.write_bytes(data.replace(b"  }\n", b"  };\r\n"))
        assert Options(liberty=(path,)).corners == ("my_cells__2_",)
        copy = chain._plain(path, tmp_path / "a b").read_bytes()
        assert copy.isascii() and b"};" not in copy and b"\r" not in copy
    assert len(read(path).all("cell")) == len(read(tmp_path / "a b" / "my_cells__2_.lib").all("cell")) > 20


@pytest.mark.needs("layout")
@pytest.mark.parametrize("missing", ["klayout", "iverilog"])
def test_a_missing_tool(capsys, tmp_path, monkeypatch, missing):
    folder = tmp_path / "bin"
    folder.mkdir()
    for tool in ("klayout", "iverilog", "vvp", "sta", "git"):
        if tool != missing and (there := shutil.which(tool)):
            (folder / tool).symlink_to(there)
    monkeypatch.setenv("PATH", str(folder))
    versions.version.cache_clear()
    try:
        line = reported(capsys, ["quad_divider", "--out", tmp_path / "out"])
    finally:
        versions.version.cache_clear()
    assert "not found; install it with: make tools" in line
    assert not (tmp_path / "out" / "quad_divider" / "summary.json").exists()


def test_a_missing_pdk(capsys, tmp_path, monkeypatch):
    tech = search.layout_platform("sky130")
    monkeypatch.setattr(search, "layout_platform", lambda pdk: replace(tech, wheel="c4m-pdk-none"))
    assert "c4m-pdk-none: not installed" in reported(capsys, ["quad_divider", "--out", tmp_path / "out"])


@pytest.mark.needs("mount")
@pytest.mark.parametrize("size", ["16k", pytest.param("128k", marks=pytest.mark.slow)])
def test_a_full_disk(capsys, tmp_path, size):
    """16k: the Verilog does not fit; 128k: the first step's files do not."""
    disk = tmp_path / "disk"
    disk.mkdir()
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "none", disk], check=True)
    try:
        line = reported(capsys, ["quad_divider", "--out", disk])
        assert "No space left" in line or "failed" in line
        assert not [path for path in disk.rglob("*") if path.name == "summary.json" or ".part-" in path.name]
    finally:
        subprocess.run(["umount", disk], check=True)


def test_an_error_of_many_lines_is_reported_in_one_line():
    error = RuntimeError("yosys failed with status 1:\nreading\nERROR: no module Top\nbye")
    assert one_line(error) == "yosys failed with status 1: ERROR: no module Top"
