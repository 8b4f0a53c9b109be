"""A divider's Verilog as a program: verilated, compiled with `main.cpp`, cached by the content of all that went in."""

import json
import shutil
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from talbot.base.cache import cached, digest
from talbot.base.paths import BUILD
from talbot.base.sources import code
from talbot.base.tools import run
from talbot.base.verilator import FAST, compile_program, runtime, verilate, verilator_version

CACHE = BUILD / "divider"
MAIN = Path(__file__).parent / "main.cpp"


@dataclass(frozen=True)
class DividerRun:
    """Result of a simulation.

    responses: uint64 (n,), DivResp messages, as many as came. cycles: of the simulation. seconds: wall clock. latency,
    interval: the least and the most, in cycles.
    """

    responses: npt.NDArray[np.uint64]
    cycles: int
    seconds: float
    latency: tuple[int, int]
    interval: tuple[int, int]


def program(verilog: str, top: str) -> Path:
    """Path of the compiled bench for module ``top`` of ``verilog`` (text). Raises ToolError."""

    def make(folder: Path) -> None:
        source = folder / "divider.v"
        source.write_text(verilog, encoding="utf-8")
        model = verilate(folder / "model", top, [source], FAST, "VQuadDivider")
        compile_program(folder / "bench", [*model, MAIN], ["-O2", *runtime()])
        shutil.rmtree(folder / "model")

    return cached(CACHE / digest(code(__name__), verilator_version(), top, verilog), make) / "bench"


def simulate(bench: Path, requests: npt.NDArray[np.uint32], noise_floor: int = 0, seed: int = 0) -> DividerRun:
    """Run ``requests`` (n,), DivReq messages, through the program ``bench``.

    seed: 0 for a source and a sink that never wait, else the random pattern in which they do. Raises ToolError.
    """
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        sent, received = Path(folder) / "requests", Path(folder) / "responses"
        np.asarray(requests, "<u4").tofile(sent)
        figures = json.loads(run([bench, sent, received, noise_floor, seed]))
        responses = np.fromfile(received, "<u8")
    latency, interval = (tuple(figures[name]) for name in ("latency", "interval"))
    return DividerRun(responses, figures["cycles"], figures["seconds"], latency, interval)
