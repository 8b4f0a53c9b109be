"""The frame bench as a program: Verilog in, executable out, cached by the content of all that went in."""

from collections.abc import Callable, Sequence
from pathlib import Path

from talbot.base.cache import cached, digest
from talbot.base.paths import BUILD, PACKAGE
from talbot.base.sources import code
from talbot.base.tools import ToolError, meanwhile
from talbot.base.verilator import FAST, compile_program, has_headers, runtime, verilate, verilator_version
from talbot.imaging.simulate.build import Build
from talbot.models.parameters import NO_DIVIDER
from talbot.rtl.contract import FILE as CONTRACT
from talbot.rtl.contract import contract

FRAME = Path(__file__).parent
READ = FRAME / "read_words.cpp"  # in place of Verilator's VL_FREAD_I, in all that is compiled here

# No fused multiply-add: the front end's arithmetic must round as NumPy's does, on every processor.
# -O1: a frame takes as long as with -O2, and the compiler two thirds of the time.
CXX_FLAGS = ("-O1", "-ffp-contract=off", "-DVL_FREAD_I=read_words")
PACKED = ("zlib.h", "lz4.h")  # headers of what packs an FST
VERILATOR_FLAGS = (*FAST, "-fno-split", "--output-split", "0", "-Wno-fatal")


def bench_program(build: Build, note: Callable[[str], None] = lambda text: None) -> Path:
    """Path of the compiled bench for ``build``: from the cache, or exported, verilated and compiled now.

    note: called with a line of text before each long step. Raises ToolError.
    """
    options = [*build.parameters("-G"), *([f"--trace-{build.waves}"] if build.waves else [])]
    sources = [PACKAGE / "pixels" / "afe.sv", FRAME / "bench.sv"]
    return program_of(build, "Bench", options, sources, FRAME / "main.cpp", note)


def bare_program(
    build: Build,
    note: Callable[[str], None] = lambda text: None,
    main: Path = FRAME / "bare.cpp",
    options: Sequence[str] = (),
) -> Path:
    """Path of the chip alone with ``main`` around it: by default a clock loop, for `make bench`. Raises ToolError.

    options: of g++, as -shared for a library.
    """
    return program_of(build, "AspChip", [], [], main, note, options)


def program_of(
    build: Build,
    top: str,
    options: Sequence[str],
    sources: Sequence[Path],
    main: Path,
    note: Callable[[str], None],
    cxx: Sequence[str] = (),
) -> Path:
    """Path of the program of module ``top`` of the Verilog and ``sources``, with ``main`` around it: from the cache.

    It stops in a cycle in which the chip breaks a line of the interface contract (docs/chip.md).
    options: of Verilator; cxx: of g++. note: called with a line of text before each long step. Raises ToolError.
    """
    key = digest(code(__name__), *sources, READ, CONTRACT, main, build, top, options, cxx, verilator_version())

    def make(work: Path) -> None:
        if build.waves == "fst" and not has_headers(PACKED):
            raise ToolError(
                f"waves_format = 'fst': needs {' and '.join(PACKED)} (Debian: zlib1g-dev, liblz4-dev); or vcd"
            )
        with meanwhile(runtime) as objects:  # a compiler runs while Python exports
            note("exporting the chip's Verilog")
            chip, checks = build.chip_verilog(work), work / CONTRACT.name
            checks.write_text(contract(build.lanes, build.divider != NO_DIVIDER), encoding="utf-8")
            note("translating it with Verilator")
            model = verilate(work / "obj", top, [chip, checks, *sources], [*VERILATOR_FLAGS, *options])
            note("compiling the simulator")
            unit = work / "obj" / "unit.o"
            compile_program(unit, [*model, READ, main], [*CXX_FLAGS, *cxx, *_defined(build.waves), "-c"])
            compile_program(work / "program", [], [unit, *cxx, *objects.result(), *_tracing(build.waves)])

    return cached(BUILD / "simulator" / key, make) / "program"


def _defined(waves: str) -> list[str]:
    """Options of g++ that compile what writes waves in a format, "" for none."""
    words = "-DWAVES", f"-DWAVES_{waves.upper()}", "-DVM_TRACE=1", f"-DVM_TRACE_{waves.upper()}=1"
    return [*words] if waves else []


def _tracing(waves: str) -> list[object]:
    """Options of g++ that link it."""
    return [*runtime([f"verilated_{waves}_c"]), *(["-lz", "-llz4"] if waves == "fst" else [])] if waves else []
