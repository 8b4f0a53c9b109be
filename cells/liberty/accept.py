"""Do the tools that a library is for read it without a word?"""

import shutil
import tempfile
from pathlib import Path

from base.tools import finish

SILENT, MISSING = "without a warning", "not installed"
GOOD = (SILENT, MISSING)


def readers(path):
    """{tool: SILENT, MISSING, or what it said} of Yosys and OpenSTA reading the Liberty file ``path``."""
    path = Path(path).absolute()
    with tempfile.TemporaryDirectory() as folder:
        script = Path(folder) / "read.tcl"
        script.write_text(f"read_liberty {{{path}}}\nexit\n")
        commands = {
            "yosys": ["yosys", "-q", "-p", f"read_liberty {path}"],
            "opensta": ["sta", "-no_splash", "-exit", script],
        }
        return {tool: _said(command) for tool, command in commands.items()}


def _said(command):
    if not shutil.which(command[0]):
        return MISSING
    done = finish(command)
    said = (done.stdout + done.stderr).strip()
    return said[-500:] if said else SILENT if done.returncode == 0 else f"status {done.returncode}"
