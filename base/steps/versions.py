"""Versions of the tools and packages that a result rests on."""

import importlib.metadata
import re
import shutil
from functools import cache

from base.tools import ToolError, finish

# What to call for the version and where it stands in the answer; 'python NAME' is the Python package NAME
COMMANDS = {
    "yosys": (["yosys", "-V"], r"Yosys (\S+)"),
    "yosys-abc": (["yosys", "-V"], r"Yosys (\S+)"),
    "klayout": (["klayout", "-v"], r"KLayout (\S+)"),
    "sta": (["sta", "-version"], r"(\S+)"),
    "ngspice": (["ngspice", "--version"], r"ngspice-(\S+)"),
    "magic": (["magic", "--version"], r"(\S+)"),
    "iverilog": (["iverilog", "-V"], r"version (\S+)"),
}


@cache
def version(tool):
    """Of a program or a Python package, as text. Raises ToolError when it is not there."""
    if tool in COMMANDS:
        command, pattern = COMMANDS[tool]
        if not shutil.which(command[0]):
            raise ToolError(f"{command[0]}: not found; install it with: make tools")
        said = finish(command)
        match = re.search(pattern, said.stdout + said.stderr)
        return match[1] if match else "unknown"
    package = tool.removeprefix("python ")
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        raise ToolError(f"{package}: not installed; make layout installs it into .venv") from None
