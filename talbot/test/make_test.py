"""make's variables as a user types them, through the real Makefile: what reaches the program, and what is refused."""

import os
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

from talbot.base.command import Parser, add_command
from talbot.base.paths import ROOT
from talbot.commands import command, main
from talbot.front import COMMANDS, WIDTH
from talbot.make import arguments, variables

READY = [
    word
    for name in ("ready", "video-ready", "tests-ready", "layout-ready", "lint-ready", "explore-ready")
    for word in ("-o", f".venv/.{name}")
]


def make(*words, ready=READY, **environment):
    """Run make here; what the tests' own make said does not count, and nothing is set up."""
    own = {name: v for name, v in os.environ.items() if not name.startswith(("MAKE", "MFLAGS", "TALBOT"))}
    words = ["make", *ready, "-o", "have-tools", *words]
    return subprocess.run(words, cwd=ROOT, env=own | environment, capture_output=True, text=True)


@dataclass
class Asked:
    """make with a program in Python's place that prints what it is given; then Talbot with that, in this process.

    To start Python for each of many commands took a twentieth of all tests' time.
    """

    patch: pytest.MonkeyPatch
    capsys: pytest.CaptureFixture[str]
    python: Path

    def __call__(self, *words):
        """Status, and lines on standard error."""
        passed = make(f"PY={self.python}", *words).stdout.split("\0")
        flags, *argv = passed[:-1]
        assert f" PY={self.python}" in flags and argv[:2] == ["-m", "talbot"]
        self.patch.setenv("MAKEFLAGS", flags.replace(f" PY={self.python}", ""))
        self.patch.setenv("MAKELEVEL", "1")
        try:
            status = main(argv[2:])
        except SystemExit as stop:
            status = stop.code
        out, err = self.capsys.readouterr()
        assert not out
        return status, err.splitlines()


@pytest.fixture
def asked(monkeypatch, capsys, tmp_path):
    python = tmp_path / "python"
    python.write_text('#!/bin/sh\nprintf \'%s\\0\' "$MAKEFLAGS" "$@"\n')
    python.chmod(0o755)
    monkeypatch.chdir(ROOT)
    return Asked(monkeypatch, capsys, python)


@pytest.mark.parametrize(
    "words, said",
    [
        ("sim SCEEN=coins", "SCEEN = 'coins': must be a variable of make sim; did you mean SCENE?"),
        ("sim scene=coins", "scene = 'coins': must be a variable of make sim; did you mean SCENE?"),
        ("sim QWERTZ=7", "QWERTZ = '7': must be a variable of make sim: SCENE, DEPTH, "),
        ("-j3 sim SCENES=coins", "did you mean SCENE?"),
        ("sim SCENE=a$b.png", "scene = 'a$b.png': no such file"),
        ("sim SCENE=$(touch)b#c'd.png", 'scene = "$(touch)b#c\'d.png": no such file'),
        ("sim SCENE=a.png SCENE=b.png", "scene = 'b.png': no such file"),
        ("sim WINDOW=-1:3,0:2", "window rows = '-1': must be an integer in 0..95"),
        ("sim PHASE=maybe", "PHASE = 'maybe': must be 1 or 0"),
        ("sim MODE=tof PHASE=0 ROWS=x", "rows = 'x'"),
        ("sim PHASE=1", "phase = True: needs mode 'tof'"),
        ("sequence SCENES=x.gif", "did you mean SCENE?"),
        ("sequence SCENE=none.mp4", "scene = 'none.mp4': no such file"),
        ("sequence", "missing: SCENE= (see talbot sequence --help)"),
        ("lightfield MODE=edge", "MODE = 'edge': must be a variable of make lightfield: SCENE, DEPTH, "),
        ("pixel PERIOD_UM=7", "period_um = 7.0: must be a number in [0.1, 5.0]"),
        ("pixel PDKS=sky130", "PDKS = 'sky130': must be a variable of make pixel; did you mean PDK?"),
        ("sim PIXEL=gf180", "pixel = 'gf180': must be one of ideal, sky130, ihp-sg13g2"),
        ("tradeoff SCENE=coins", "SCENE = 'coins': must be a variable of make tradeoff: SENSOR, ONLY, WORKERS, OUT"),
        ("mutate SEDE=2", "did you mean SEED?"),
        ("layout DESIGN=none", "DESIGN = 'none': must be one of "),
        ("layout DESIGN=amp_ctrl UTILISATION=0.8", "did you mean UTILIZATION?"),
        ("openroad UNTIMED=1", "UNTIMED = '1': must be a variable of make openroad: "),
        ("layout LIBERTY=a.lib", "liberty = a.lib: no such file"),
        ("handoff DESING=amp_ctrl", "did you mean DESIGN?"),
        ("handoff DESIGN=none", "'none': must be one of "),
        ("verilog TOP=Nothing", "invalid choice: 'Nothing'"),
        ("cells LIBRARY=x", "LIBRARY = 'x': must be a variable of make cells"),
    ],
)
def test_refused_by_the_command_in_one_line(words, said, asked):
    status, lines = asked(*words.split(" "))
    lines = [line for line in lines if not re.match(r"talbot: \w+ of the env", line)]
    assert status == 2 and len(lines) == 1, lines
    assert lines[0].startswith("talbot: error: ") and said in lines[0]


@pytest.mark.parametrize(
    "scene, installs",
    [("CLIP.MP4", True), ("a b.Mov", True), ("x/clip.m2ts", True), ("clip.gif", False), ("$(error no).MKV", True)],
)
def test_a_video_of_any_case_installs_its_package(scene, installs):
    ready = "-o", ".venv/.ready"
    result = make("-n", "-W", "requirements/video.lock", "sequence", f"SCENE={scene}", ready=ready)
    assert result.returncode == 0 and ("requirements/video.lock" in result.stdout) == installs


def test_the_program_itself_refuses_and_its_status_is_makes():
    result = make("sim", "SCENE=a$b c.png")
    assert result.returncode == 2 and not result.stdout
    first, *rest = [line for line in result.stderr.splitlines() if not re.match(r"talbot: \w+ of the env", line)]
    assert first.startswith("talbot: error: scene = 'a$b c.png': no such file")
    assert [line[:10] for line in rest] == ["make: *** "]


@pytest.mark.parametrize("words", ["test COMPLET=1", "clean SCENE=coins", "SCEEN=coins", "lint FIX=1", "tools A=$(x"])
def test_refused_by_make_before_anything_runs(words):
    result = make(*words.split(" "))
    name, _, value = words.split()[-1].partition("=")
    assert result.returncode == 2 and result.stderr.count("\n") == 1 and not result.stdout
    assert f"{name} = '{value}': must be a variable of make " in result.stderr and "PDK_ROOT" in result.stderr


@pytest.mark.parametrize(
    "words, said",
    [("layout DESIGN=none", "DESIGN = 'none'"), ("pixel PITCH_UM=x", "pitch_um"), ("cells CORNERS=x", "corner = 'x'")],
)
def test_arguments_are_checked_before_packages_are_installed_for_them(words, said):
    """The lock is new, so the packages of layouts would be installed."""
    own = {name: v for name, v in os.environ.items() if not name.startswith(("MAKE", "MFLAGS", "TALBOT"))}
    command = [
        "make",
        "-W",
        "requirements/layout.lock",
        "-o",
        ".venv/.ready",
        "-o",
        ".venv/.tests-ready",
        *words.split(),
    ]
    result = subprocess.run(command, cwd=ROOT, env=own, capture_output=True, text=True)
    first, *rest = result.stderr.splitlines()
    assert result.returncode == 2 and not result.stdout and said in first
    assert all(line.startswith("make: *** ") for line in rest)


@pytest.mark.parametrize("words", ["layout --design amp_ctrl", "sim", "pixel", "analog", "cells"])
def test_checked_arguments_begin_no_work(words, monkeypatch, capsys, tmp_path):
    monkeypatch.setenv("TALBOT_CHECK", "1")
    monkeypatch.chdir(tmp_path)
    name, *more = words.split()
    assert main([name, *more[1:]]) == 0
    assert capsys.readouterr() == ("", "") and not any(tmp_path.iterdir())


def test_dry_runs_and_variables_of_an_outer_make_pass():
    assert "talbot --make" in make("-n", "sim", "SCENE=coins").stdout
    assert "--complete" in make("-n", "test", "COMPLETE=1").stdout
    assert "--complete" not in make("-n", "test", "COMPLETE=0").stdout
    inner = make("sim", "SCENE=nowhere.png", MAKELEVEL="1", MAKEFLAGS=" -- CC=gcc")
    assert "scene = 'nowhere.png': no such file" in inner.stderr


def test_a_variable_of_the_environment_is_named_not_taken():
    result = make("sim", "ROWS=x", SCENE="coins", CI="1")
    assert "talbot: SCENE of the environment is not used: make sim SCENE=...\n" in result.stderr
    assert "CI" not in result.stderr and "rows = 'x'" in result.stderr


def test_make_e_takes_variables_of_the_environment():
    assert "scene = 'nowhere.png'" in make("-e", "sim", SCENE="nowhere.png").stderr
    assert "cols = 'y'" in make("-e", "sim", "COLS=y", COLS="z").stderr
    assert "scene = 'a$b \\\\c.png'" in make("-e", "sim", "SCENE=a$b \\c.png").stderr


def test_a_users_own_settings_do_not_reach_the_program(tmp_path):
    (tmp_path / "numpy.py").write_text('raise ImportError("for another Python")\n')
    (tmp_path / "rc").write_text("exit 7\n")
    python = dict.fromkeys(("PYTHONPATH", "PYTHONHOME", "PYTHONSTARTUP"), str(tmp_path)) | {"PYTHONWARNINGS": "error"}
    others = {
        "MPLBACKEND": "module://matplotlib_inline.backend_inline",
        "BASH_ENV": str(tmp_path / "rc"),
        "LC_ALL": "C",
    }
    result = make("sim", "ROWS=x", CDPATH="/", GREP_OPTIONS="-v", LD_PRELOAD="/no/lib.so", **python, **others)
    first, *_ = [line for line in result.stderr.splitlines() if "ld.so" not in line]
    assert first.startswith("talbot: error: rows = 'x'")


def targets():
    """The targets of the Makefile and their recipes, by make's own reading of it."""
    known = {name for name in make("-pRrq", "help").stdout.split() if re.fullmatch("[a-z-]+:", name)}
    (phony,) = re.findall(r"(?m)^\.PHONY: (.*)$", make("-pRrq", "help").stdout)
    return {name for name in phony.split() if f"{name}:" in known} - {"have-tools", "help"}


def test_the_help_lists_every_target_and_every_command():
    text = make("help", PYTHON=sys.executable).stdout
    assert text == make(PYTHON=sys.executable).stdout and max(map(len, text.splitlines())) <= WIDTH
    shown = re.findall(r"(?m)^  ([a-z-]+) ", text)
    assert sorted(shown) == sorted(targets())
    assert {*COMMANDS} - {*shown} == {name for name, command in COMMANDS.items() if not command.target}


def test_every_target_passes_its_variables_or_knows_that_it_has_none():
    (plain,) = re.findall(r"^PLAIN := (.*)$", (ROOT / "Makefile").read_text(), re.M)
    with_command = {name for name in targets() if f"{name} PYTHON" in make("-n", name).stdout}
    assert with_command == {name for name, command in COMMANDS.items() if command.target}
    assert targets() == with_command | {*plain.split()} - {"help", "%-help", "have-tools"}


def test_the_options_of_a_command():
    shown = make("sim-help")
    assert shown.returncode == 0 and "--scene SCENE" in shown.stdout


@pytest.mark.parametrize(
    "name, fixed, flags, expected",
    [
        ("sim", [], " -- SCENE=a\\ b$$c PHASE=yes SEED=", ["--scene=a b$c", "--phase"]),
        ("sim", [], "rR --jobserver-auth=3,4 -- PHASE=0", []),
        ("layout", [], " -- LIBERTY=a.lib\\ b.lib DESIGN=-x", ["--liberty=a.lib", "--liberty=b.lib", "--", "-x"]),
        ("verilog", ["--out", "o", "--check"], " -- CHECK=off N_FRAC=6", ["--out", "o", "--n-frac=6"]),
        ("coverage", [], " -- ONLY=EdgeAdc\\ RegFile", ["--only", "EdgeAdc", "RegFile"]),
        ("handoff", ["--design", "asp_chip"], " -- DESIGN=0", ["--design", "asp_chip", "--design=0"]),
    ],
)
def test_variables_become_arguments(name, fixed, flags, expected):
    parser = Parser()
    add_command(parser, command(name))
    assert arguments(parser, name, fixed, {"MAKEFLAGS": flags, "MAKELEVEL": "1"}) == expected


def test_a_home_folder_is_meant_by_a_tilde(monkeypatch, capsys):
    monkeypatch.setenv("HOME", "/home/me")
    parser = Parser()
    add_command(parser, command("layout"))
    flags = {"MAKEFLAGS": " -- OUT=~/res LIBERTY=~/a.lib\\ b~.lib", "MAKELEVEL": "1"}
    expected = ["--liberty=/home/me/a.lib", "--liberty=b~.lib", "--out=/home/me/res"]
    assert arguments(parser, "layout", [], flags) == expected
    with pytest.raises(SystemExit):
        arguments(parser, "layout", [], {"MAKEFLAGS": " -- OUT=~nobody-here/x", "MAKELEVEL": "1"})
    assert "OUT = '~nobody-here/x': must begin with a user's home folder" in capsys.readouterr().err


def test_quoting_of_makeflags():
    assert variables("n -- A=1\\\\2\\ 3\nx B:=$$(y) C=") == {"A": "1\\2 3\nx", "B": "$(y)", "C": ""}
    assert variables("-n") == variables("") == {}


@pytest.mark.parametrize(
    "flags, expected",
    [
        (" -- SCENE=coins", {"SCENE": "coins"}),
        ("s -- SCENE=a\\ b M=1", {"SCENE": "a b", "M": "1"}),
        ("SCENE=coins M=1", {"SCENE": "coins", "M": "1"}),
        ("s --jobserver-fds=3,4 -j", {}),
        (" --jobserver-fds=3,4 -j", {}),
        ("", {}),
    ],
)
def test_variables_of_every_make(flags, expected):
    """The third is as make 3.81, macOS's, passes them without an option."""
    assert variables(flags) == expected
