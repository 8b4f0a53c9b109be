"""Yosys and yosys-smtbmc on one wrapper."""

import json
import os
import re
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Self

from talbot.base.environment import of_tools
from talbot.base.tools import ToolError, finish, located
from talbot.verif.formal.netlist import Netlist

PASSED, FAILED, TIMEOUT, UNKNOWN = "passed", "failed", "timeout", "unknown"
UNDECIDED = TIMEOUT, UNKNOWN


class FormalError(ToolError):
    """A tool is missing or cannot read a design."""


@cache
def tool(name: str) -> str:
    """Return the path of a tool (`base.tools.located`). Raises FormalError."""
    path = located(name)
    if not path:
        raise FormalError(f"tool = {name}: not found; make setup installs it")
    return path


@cache
def version(name: str) -> str:
    """Return the version that a tool prints, one line. Raises FormalError."""
    option = {"yosys": "-V", "z3": "--version", "boolector": "--version"}[name]
    result = subprocess.run([tool(name), option], capture_output=True, text=True, timeout=300, env=of_tools())
    if result.returncode:
        raise FormalError(f"tool = {name}: {tool(name)} {option} ended with {result.returncode}")
    line = result.stdout.strip().splitlines()[-1]
    wheel = " (wheel)" if Path(tool(name)).name.startswith(("yowasp-", "talbot-")) else ""
    return f"{name if line[0].isdigit() else ''} {line.split('(git')[0]}".strip() + wheel


def flat(designs: Mapping[str, str], wrapper: str, top: str, assumed: Iterable[str]) -> list[str]:
    """Return the Yosys commands that read files in the working directory into one flat module.

    designs: module -> file. assumed: labels of the only assumptions that may be in it.
    """
    lines = []
    for module, file in designs.items():  # each by itself: files may share names of submodules
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
        "write_json hierarchy.json",
        "flatten",
        "select -assert-none w:* a:hierconn %i",
        "memory -nordff",
        "opt_clean",
        "async2sync",
        "chformal -lower",
    ]
    listed = "".join(f" c:{label} c:*.{label} %u %d" for label in assumed)
    return [*lines, f"select -assert-none t:$assume{listed} t:$fair t:$live %u"]


def smt2(only: str | None = None, invariants: bool = True) -> list[str]:
    """Return the Yosys commands that write the flat module to proof.smt2.

    only: the one assertion to keep. invariants: whether to keep those of the induction, inv_...
    """
    lines, asserts = [], "t:$assert"
    if only:
        lines += [f"select -assert-count 1 {asserts} c:{only} %i", f"chformal -assert -remove {asserts} c:{only} %d"]
    if not invariants:
        lines += [f"chformal -assert -remove {asserts} c:inv_* %i"]
    return [
        *lines,
        "setundef -undriven -anyseq",
        "opt -keepdc -nodffe -nosdff",
        "check -assert",
        "write_smt2 -wires proof.smt2",
    ]


@dataclass(frozen=True)
class Answer:
    """What yosys-smtbmc reports. status: 'passed', 'failed', 'timeout' or 'unknown'. wall_s: seconds it took."""

    status: str
    output: str
    wall_s: float


class Workplace:
    """A temporary folder with a design and its wrapper, in which `check` runs yosys-smtbmc."""

    def __init__(
        self,
        texts: Mapping[str, str],
        wrapper: str,
        top: str,
        assumed: Iterable[str],
        write: Iterable[str] = (),
        edit: Callable[[Netlist], None] | None = None,
    ) -> None:
        """Write the files and run Yosys. Raises FormalError where it refuses them.

        texts: module -> its Verilog. assumed: labels of the only assumptions there may be. write: Yosys commands that
        write the flat module, by default `smt2`. edit: changes the flat netlist.
        """
        self.folder = tempfile.TemporaryDirectory(prefix="talbot-formal-")
        self.path = Path(self.folder.name)
        for module, text in texts.items():
            (self.path / f"{module}.v").write_text(text, encoding="utf-8")
        (self.path / "wrapper.sv").write_text(wrapper, encoding="utf-8")
        for name in ("boolector", "z3"):  # yosys-smtbmc looks for the bare name
            if Path(located(name) or "").name.startswith("yowasp"):
                (self.path / name).symlink_to(tool(name))
        read = flat({module: f"{module}.v" for module in texts}, "wrapper.sv", top, assumed)
        if edit:
            self._yosys([*read, "write_json flat.json"])
            netlist = Netlist(self._json("flat"), top, self._json("hierarchy"))
            edit(netlist)
            (self.path / "edited.json").write_text(json.dumps(netlist.design), encoding="utf-8")
            read = ["read_json edited.json"]
        self._yosys([*read, *(write or smt2())])

    def _json(self, name: str) -> dict[str, Any]:
        return json.loads((self.path / f"{name}.json").read_text(encoding="utf-8"))

    def _yosys(self, script: Iterable[str]) -> None:
        (self.path / "proof.ys").write_text("\n".join(script) + "\n", encoding="utf-8")
        result = finish([tool("yosys"), "-q", "proof.ys"], cwd=self.path)
        if result.returncode:
            self.folder.cleanup()
            errors = [line for line in (result.stdout + result.stderr).splitlines() if "ERROR" in line]
            raise FormalError(f"yosys = {(errors or ['no message'])[-1]}")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.folder.cleanup()

    def check(self, engine: str, options: Iterable[str], timeout: float) -> Answer:
        """Run yosys-smtbmc for at most ``timeout`` seconds."""
        version(engine)  # at its first run the wheel prints other lines, too
        command = [tool("yosys-smtbmc"), "-s", engine, "--unroll", "--noprogress", *options, "proof.smt2"]
        environment = of_tools({"PATH": f"{self.path}{os.pathsep}{os.environ['PATH']}"})
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
            output = process.communicate()[0] + f"timeout after {timeout} s"
            return Answer(TIMEOUT, output, time.monotonic() - begin)
        reported = re.findall(r"Status: (\w+)", output)
        status = {"PASSED": PASSED, "FAILED": FAILED}.get(reported[-1] if reported else "", UNKNOWN)
        if (status == PASSED) != (process.returncode == 0):
            status = UNKNOWN
        return Answer(status, output, time.monotonic() - begin)
