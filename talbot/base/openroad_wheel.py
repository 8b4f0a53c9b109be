"""The program `openroad` from the Python package of the same name (`pip install openroad`), which brings none.

    python openroad_wheel.py [-threads N] [other options] SCRIPT

The Python has the package, or requirements/venv.sh has unpacked it in the environment. Options are those of the
program; those without a meaning here are ignored.
"""

import ctypes
import sys
from importlib import import_module
from importlib.metadata import distribution
from pathlib import Path

# The package holds Tcl's own library, which its Tcl does not find: init.tcl loads commands such as `clock`. Nor does
# this Tcl ask for the locale, by which paths are UTF-8
SCRIPT = """
encoding system utf-8
load {{}} Design
set tcl_library {{{library}}}
source $tcl_library/init.tcl
set_thread_count {threads}
if {{[catch {{source {{{script}}}}} message options]}} {{
  puts stderr [dict get $options -errorinfo]
  exit 1
}}
exit 0
"""


def main(arguments: list[str]) -> None:
    """Print the version, or run the Tcl file; ends the process: 1 where a command of the file fails."""
    sys.path.append(str(Path(sys.prefix, "openroad", "package")))  # as talbot/base/openroad.py calls it
    package = distribution("openroad")
    if arguments == ["-version"]:
        print(package.version)
        return
    openroad = import_module("openroad")
    threads = arguments[arguments.index("-threads") + 1] if "-threads" in arguments else 1
    library = package.locate_file("library")
    tech = openroad.Tech()  # a Design does not keep it, and crashes without
    design = openroad.Design(tech)
    tcl = ctypes.CDLL(str(Path(str(library)).with_name("_openroadpy.so")))

    @ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)
    def associate(interpreter: int) -> int:
        """Give commands of the floorplan their Design, which only the program's own start did before 2026."""
        tcl.Tcl_SetAssocData(ctypes.c_void_p(interpreter), b"design", None, ctypes.c_void_p(int(design.this)))
        return 0

    tcl.Tcl_StaticPackage(None, b"Design", associate, None)
    message = design.evalTclString(SCRIPT.format(library=library, threads=threads, script=arguments[-1]))
    sys.exit(f"openroad: {message}")  # the script ends the process, where it comes that far


if __name__ == "__main__":
    main(sys.argv[1:])
