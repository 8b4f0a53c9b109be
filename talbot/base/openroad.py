"""OpenROAD on this machine: the program, or the Python package of its developers, which brings none.

The package is for x86-64 with glibc 2.38 and later. On an older system requirements/venv.sh unpacks it and a newer C
library in a folder of the environment; under that library's loader any Python runs it. With zlib 1.3.2 and later it
crashes, since Python's zlib takes a part of its calls: there the folder has an older zlib.
"""

import shutil
import sys
from importlib.util import find_spec
from pathlib import Path

from talbot.base.tools import ToolError

LAUNCHER = Path(__file__).with_name("openroad_wheel.py")
LOADER = Path("/lib64/ld-linux-x86-64.so.2")
OPTIONS = "-no_init", "-no_splash", "-exit"
INSTALL = (
    "make setup-layout installs it on Linux with x86-64 and glibc 2.38, Debian 12 or Ubuntu 22.04; "
    "elsewhere: https://openroad.readthedocs.io"
)


def program() -> list[str]:
    """Command line of OpenROAD without arguments: the program on PATH, else the package; [] where neither is there."""
    if shutil.which("openroad"):
        return ["openroad"]
    # -P: the launcher's folder has modules with names of the standard library's
    python = [sys.executable, "-P", str(LAUNCHER)]
    libraries = Path(sys.prefix) / "openroad" / "libc"
    if not libraries.is_dir():
        return python if find_spec("_openroadpy") else []
    loader = libraries / LOADER.name
    return [str(loader if loader.is_file() else LOADER), "--library-path", str(libraries), *python]


def command(script: Path | str, threads: int | str = 1) -> list[str]:
    """Command line that runs a Tcl file in OpenROAD. threads: a number or 'max'. Raises ToolError without OpenROAD."""
    start = program()
    if not start:
        raise ToolError(f"openroad: not found; {INSTALL}")
    return [*start, *OPTIONS, "-threads", str(threads), str(script)]
