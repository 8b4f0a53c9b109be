"""The frame bench as a program: Verilog in, executable out, cached by the content of all that went in."""

from collections.abc import Callable, Sequence
from pathlib import Path

from talbot.base.cache import cached, digest
from talbot.base.paths import BUILD, PACKAGE
from talbot.base.sources import code
from talbot.base.verilator import FAST, compile_program, runtime, verilate, verilator_version

from .build import Build

FRAME = Path(__file__).parent

# No fused multiply-add: the front end's arithmetic must round as NumPy's does, on every processor.
CXX_FLAGS = ("-O2", "-ffp-contract=off")
VERILATOR_FLAGS = (*FAST, "-fno-split", "--output-split", "0", "-Wno-fatal")


def bench_program(build: Build, note: Callable[[str], None] = lambda text: None) -> Path:
    """Path of the compiled bench for ``build``: from the cache, or exported, verilated and compiled now.

    note: called with a line of text before each long step. Raises ToolError.
    """
    options = [*build.parameters("-G"), *(["--trace"] if build.waves else [])]
    sources = [PACKAGE / "pixels" / "afe.sv", FRAME / "bench.sv"]
    return _cached(build, "Bench", options, sources, FRAME / "main.cpp", note)


def bare_program(
    build: Build,
    note: Callable[[str], None] = lambda text: None,
    main: Path = FRAME / "bare.cpp",
    options: Sequence[str] = (),
) -> Path:
    """Path of the chip alone with ``main`` around it: by default a clock loop, for `make bench`. Raises ToolError.

    options: of g++, as -shared for a library.
    """
    return _cached(build, "AspChip", [], [], main, note, options)


def _cached(
    build: Build,
    top: str,
    options: Sequence[str],
    sources: Sequence[Path],
    main: Path,
    note: Callable[[str], None],
    cxx: Sequence[str] = (),
) -> Path:
    key = digest(code(__name__), *sources, main, build, top, options, cxx, verilator_version())

    def make(work: Path) -> None:
        note("exporting the chip's Verilog")
        chip = build.chip_verilog(work)
        note("translating it with Verilator")
        model = verilate(work / "obj", top, [chip, *sources], [*VERILATOR_FLAGS, *options])
        note("compiling the simulator")
        traced = ["-DWAVES", "-DVM_TRACE=1", "-DVM_TRACE_VCD=1"] if build.waves else []
        objects = [*runtime(), *(runtime(["verilated_vcd_c"]) if build.waves else [])]
        compile_program(work / "program", [*model, main], [*CXX_FLAGS, *cxx, *traced, *objects])

    return cached(BUILD / "simulator" / key, make) / "program"
