"""OpenROAD's Python package instead of the program: which is called, and the package itself where it is installed."""

import shutil
import sys
from pathlib import Path

import pytest

from talbot.base import openroad
from talbot.base.steps.versions import version
from talbot.base.tools import ToolError, finish

LEF = """VERSION 5.8 ;
UNITS DATABASE MICRONS 1000 ; END UNITS
SITE unit CLASS CORE ; SIZE 0.5 BY 2 ; END unit
LAYER m1 TYPE ROUTING ; DIRECTION HORIZONTAL ; PITCH 0.5 ; WIDTH 0.2 ; END m1
END LIBRARY
"""
FLOORPLAN = """read_lef cells.lef
read_verilog top.v
link_design top
initialize_floorplan -site unit -die_area {0 0 20 20} -core_area {0 0 20 20}
make_tracks
puts "rows [llength [[ord::get_db_block] getRows]] [clock format 0 -gmt 1 -format %Y]"
"""


def called(tmp_path, script):
    """The run of a Tcl file by the launcher."""
    (tmp_path / "cells.lef").write_text(LEF)
    (tmp_path / "top.v").write_text("module top (); endmodule\n")
    (tmp_path / "script.tcl").write_text(script)
    return finish(openroad.command("script.tcl", "max"), cwd=tmp_path)


def test_the_program_comes_before_the_package_with_its_own_libraries(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(sys, "path", [str(tmp_path)])
    monkeypatch.setattr(sys, "prefix", str(tmp_path))
    monkeypatch.delitem(sys.modules, "_openroadpy", raising=False)
    with pytest.raises(ToolError, match="openroad: not found; make setup-layout installs it"):
        openroad.command("a.tcl")
    python = [sys.executable, "-P", str(openroad.LAUNCHER)]
    (libc := tmp_path / "openroad" / "libc").mkdir(parents=True)
    (libc / "ld-linux-x86-64.so.2").write_text("")
    assert openroad.program() == [str(libc / "ld-linux-x86-64.so.2"), "--library-path", str(libc), *python]
    (libc / "ld-linux-x86-64.so.2").unlink()  # the system's, with another zlib
    assert openroad.program() == ["/lib64/ld-linux-x86-64.so.2", "--library-path", str(libc), *python]
    shutil.rmtree(tmp_path / "openroad")
    (tmp_path / "_openroadpy.py").write_text("")
    assert openroad.program() == python
    (tmp_path / "_openroadpy.py").unlink()
    (tmp_path / "openroad").write_text("#!/bin/sh\n")
    (tmp_path / "openroad").chmod(0o755)
    words = ["openroad", "-no_init", "-no_splash", "-exit", "-threads", "max", "a.tcl"]
    assert openroad.command(Path("a.tcl"), "max") == words


@pytest.mark.needs("openroad")
def test_a_script_runs_to_its_end(tmp_path):
    done = called(tmp_path, FLOORPLAN)
    assert done.returncode == 0 and "rows 10 1970" in done.stdout, done.stdout + done.stderr


@pytest.mark.needs("openroad")
@pytest.mark.parametrize(
    "line, status, said", [("exit 4", 4, ""), ("nosuch", 1, "nosuch"), ("read_lef no.lef", 1, "no.lef does not exist")]
)
def test_a_command_that_fails_ends_it(line, status, said, tmp_path):
    done = called(tmp_path, f"puts begun\n{line}\nputs ended\n")
    assert done.returncode == status and "begun" in done.stdout and "ended" not in done.stdout
    assert said in done.stdout + done.stderr


@pytest.mark.needs("openroad")
def test_a_path_with_a_space_and_an_umlaut(tmp_path):
    (folder := tmp_path / "Prüf stand").mkdir()
    (folder / "script.tcl").write_text("puts [file tail [info script]]\n")
    done = finish(openroad.command(folder / "script.tcl"))
    assert done.returncode == 0 and "script.tcl" in done.stdout, done.stdout + done.stderr


@pytest.mark.needs("openroad")
def test_a_script_that_does_not_come_to_its_end_fails(tmp_path, monkeypatch):
    (launcher := tmp_path / "wheel.py").write_text(openroad.LAUNCHER.read_text().replace("/init.tcl", "/no.tcl"))
    monkeypatch.setattr(openroad, "LAUNCHER", launcher)
    if str(launcher) in (words := openroad.command("a.tcl")):  # the wheel, not a program of the PATH
        done = finish(words)
        assert done.returncode == 1 and "no.tcl" in done.stderr, done.stdout + done.stderr


@pytest.mark.needs("openroad")
def test_its_version_is_of_digits():
    # Not that kept of another test's program
    assert (said := version.__wrapped__("openroad"))[0].isdigit(), said
