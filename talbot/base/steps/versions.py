"""Versions of the tools and packages that decide a result."""

import importlib.metadata
import re
from functools import cache

from talbot.base.openroad import program
from talbot.base.tools import ToolError, finish, located

# Command that prints the version, and the pattern of it in the output; 'python NAME' is the Python package NAME
COMMANDS = {
    "yosys": (["yosys", "-V"], r"Yosys (\S+)"),
    "yosys-abc": (["yosys", "-V"], r"Yosys (\S+)"),
    "klayout": (["klayout", "-v"], r"KLayout (\S+)"),
    "ngspice": (["ngspice", "--version"], r"ngspice-(\S+)"),
    "magic": (["magic", "--version"], r"(\S+)"),
    "iverilog": (["iverilog", "-V"], r"version (\S+)"),
}


@cache
def version(tool: str) -> str:
    """Version of a program or a Python package. Raises ToolError when it is not installed."""
    if tool in COMMANDS or tool == "openroad":
        command, pattern = COMMANDS.get(tool) or ([*(program() or [tool]), "-version"], r"(\S+)")
        if not located(command[0]):
            raise ToolError(f"{command[0]}: not found; install it with: make tools")
        done = finish(command)
        match = re.search(pattern, done.stdout + done.stderr)
        return match[1] if match else "unknown"
    package = tool.removeprefix("python ")
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        raise ToolError(f"{package}: not installed; make layout installs it into .venv") from None
