"""How OpenROAD is called: the program, or the Python package of its developers, which brings none."""

import shutil
import sys
from importlib.util import find_spec
from pathlib import Path

LAUNCHER = Path(__file__).with_name("wheel.py")
INSTALL = (
    "https://openroad.readthedocs.io (packages, source), a LibreLane or flow-scripts container, or: pip install "
    "openroad (Linux on x86-64 with glibc 2.38 or later: Debian 13, Ubuntu 24.04)"
)


def openroad() -> list[str]:
    """The program on PATH, else the launcher for the package in this Python; empty where neither is installed."""
    if shutil.which("openroad"):
        return ["openroad"]
    # -P: the launcher's folder has modules with names of the standard library's
    return [sys.executable, "-P", str(LAUNCHER)] if find_spec("openroad") else []
