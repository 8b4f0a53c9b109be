"""The environment that our programs run in: without a user's own settings of Python, Matplotlib, make and the tools.

A deny-list: a program may need any variable to run at all (PATH, LD_LIBRARY_PATH, those of modules, Nix and Conda,
proxies, PDK_ROOT), and a list of those to keep breaks a machine that is not known here. What changes a result has a
name that the program itself defines, and most of these share a prefix. Files of settings in the home folder
(.spiceinit, .sta, .klayout, .magicrc) are out of a tool's sight because its HOME is no folder.

Standard library only: `talbot.__main__` calls `start_again` before any package is imported.
"""

import os
import re
import sys
from collections.abc import Mapping

DENIED = re.compile(
    # Python: where it looks for modules, asserts, warnings, encodings. PYTHON itself is make's variable
    r"PYTHON(?!PYCACHEPREFIX|UNBUFFERED|FAULTHANDLER|DONTWRITEBYTECODE).+"
    r"|(MPLBACKEND|MATPLOTLIB|PYTEST_(?!XDIST|CURRENT)|COVERAGE_|NPY_|SCIPY_|PIL_|NUMBA_(?!NUM_THREADS|CACHE_DIR)).*"
    # The shell, grep, make and the compiler
    r"|BASH_ENV|BASH_FUNC_.*|ENV|CDPATH|GLOBIGNORE|SHELLOPTS|BASHOPTS|POSIXLY_CORRECT|GREP_.*|IFS"
    r"|MAKE|MAKE(FILES|FLAGS|OVERRIDES|LEVEL|_.*)|GNUMAKEFLAGS|MFLAGS|OBJCACHE|(C|CXX|CPP|LD|AS|F)FLAGS"
    r"|DEPENDENCIES_OUTPUT|SUNPRO_DEPENDENCIES|GCC_(?!EXEC_PREFIX).*"
    # The tools. SPICE_ and NGSPICE_: where ngspice finds its code models and its start-up file
    r"|VERILATOR_.*|SYSTEMC.*|IVERILOG_.*|IVL_.*|YOSYS_.*|ABC_?RC|(NG)?SPICE.*|STA_.*|KLAYOUT_.*|CAD_ROOT|MAGIC_.*|MAGTYPE"
    r"|NETGEN_.*|TCL.*|TK_.*|COCOTB_.*|GPI_.*|QT_.*|RUBY(OPT|LIB)|PERL5(OPT|LIB)"
    # Libraries put in front of any program's, and the language of messages that we read
    r"|LD_PRELOAD|DYLD_INSERT_LIBRARIES|LANG|LANGUAGE|LC_.*"
)
FIXED = {"LC_ALL": "C.UTF-8", "PYTHONUTF8": "1", "MATPLOTLIBRC": os.devnull}
OF_MAKE = "MAKEFLAGS", "MAKELEVEL"  # of the make that started this program, for talbot.make
NO_HOME = "/nonexistent"  # as Debian's account nobody has it
# Folders of the tools that requirements/tools.sh unpacks for a user who is not root, behind those of the system
UNPACKED = {"PATH": "bin", "CPATH": "include", "LIBRARY_PATH": "lib", "LD_RUN_PATH": "lib"}


def clean(environment: Mapping[str, str] = os.environ) -> dict[str, str]:
    """Return ``environment`` without a user's settings: messages in English, text in UTF-8, unpacked tools on PATH."""
    kept = {name: value for name, value in environment.items() if not DENIED.fullmatch(name)}
    return kept | FIXED | with_unpacked(environment)


def open_standard_files() -> None:
    """Open /dev/null for input, output and errors where they are closed: a file that is opened would take the place."""
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        try:
            os.fstat(number)
        except OSError:
            os.set_inheritable(os.open(os.devnull, os.O_RDWR), True)  # it has the lowest free number, this one
            setattr(sys, name, os.fdopen(number, "w" if number else "r", encoding="utf-8", closefd=False))


def with_unpacked(environment: Mapping[str, str]) -> dict[str, str]:
    """Return the variables that find the tools of requirements/tools.sh; {} without them."""
    folder = os.path.join(_cache(environment), "talbot", "tools")
    if not os.path.isdir(os.path.join(folder, "bin")):
        return {}
    values = {}
    for name, part in UNPACKED.items():
        paths = [path for path in environment.get(name, "").split(os.pathsep) if path]
        values[name] = os.pathsep.join(dict.fromkeys([*paths, os.path.join(folder, part)]))
    return values


def _cache(environment: Mapping[str, str]) -> str:
    return environment.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")


def of_tools(more: Mapping[str, str] | None = None) -> dict[str, str]:
    """Return the environment of a tool: clean, no home folder, hashes of texts that are the same in every run.

    more: variables on top. The user's cache, where YoWASP keeps its compiled tools, stays where it is.
    """
    cache = _cache(os.environ)
    own = {"HOME": NO_HOME, "XDG_CACHE_HOME": cache, "YOWASP_CACHE_DIR": os.path.join(cache, "YoWASP")}
    own["PYTHONHASHSEED"] = "0"
    environment = {name: value for name, value in clean().items() if name != "XDG_CONFIG_HOME"}
    return environment | own | dict(more or {})


def start_again() -> None:
    """Replace this process by the same program in a clean environment, where it is not in one.

    The interpreter has read its variables (PYTHONPATH, PYTHONOPTIMIZE) before the program begins, and the encoding of
    file names, too. A folder of PYTHONPATH from which the program itself comes is kept.
    """
    wanted = clean() | {name: os.environ[name] for name in OF_MAKE if name in os.environ}
    if os.path.expanduser("~") == "~":  # a user that the system does not know: docker run -u 12345
        wanted["HOME"] = NO_HOME
    home = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    paths = [path for path in os.environ.get("PYTHONPATH", "").split(os.pathsep) if path]
    if home in map(os.path.realpath, paths) or home in map(os.path.abspath, paths):
        wanted["PYTHONPATH"] = home
    names = [name for name in os.environ.keys() | wanted.keys() if _of_python(name)]
    changed = any(os.environ.get(name) != wanted.get(name) for name in names)
    if changed and not sys.flags.ignore_environment and sys.executable:
        os.execve(sys.executable, sys.orig_argv, wanted)
    os.environ.clear()
    os.environ.update(wanted)


def _of_python(name: str) -> bool:
    """Return whether Python itself reads the variable when it starts."""
    return name.startswith("PYTHON") or name in ("LANG", "LC_ALL", "LC_CTYPE")
