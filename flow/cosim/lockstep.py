"""The lock-step program, compiled and run: one row through the chip's Verilog and a circuit."""

import contextlib
import ctypes.util
import json
import tempfile
import threading
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.base.paths import PACKAGE
from talbot.base.tools import ToolError
from talbot.base.verilator import has_headers
from talbot.flow.simulate.build import Build
from talbot.flow.simulate.frame import host_script, run_frame
from talbot.flow.simulate.verilator import FRAME, program_of
from talbot.models.afe import FrontEnd, write_converter, write_samples
from talbot.models.digital.host import command, frame_writes, write_transfers
from talbot.models.parameters import FrameParameters, SensorParameters

from .accuracy import Accuracy
from .deck import Deck, Timing

HERE = Path(__file__).parent
GAVE_UP = 5  # exit status where ngspice gives up
INTERVAL = 10.0  # s between two lines on how far a row is
LIBRARY = "ngspice"


@dataclass(frozen=True)
class Cycle:
    """A cycle of the circuit as the chip sees it: arrays (cycles,) or (cycles, lanes).

    number: of the chip's clock at its end. hold, unsigned, group, k, sub: at the pins. deciding: comparator strobed.
    asked: DAC code. answer, expected: of the circuit and of the real-number front end. held: the latter's value, LSB.
    volts: at the comparator's output at the end.
    """

    number: npt.NDArray[np.int64]
    hold: npt.NDArray[np.bool_]
    unsigned: npt.NDArray[np.bool_]
    group: npt.NDArray[np.int64]
    k: npt.NDArray[np.int64]
    sub: npt.NDArray[np.int64]
    deciding: npt.NDArray[np.bool_]
    asked: npt.NDArray[np.int64]
    answer: npt.NDArray[np.bool_]
    expected: npt.NDArray[np.bool_]
    held: npt.NDArray[np.float64]
    volts: npt.NDArray[np.float64]


@dataclass(frozen=True)
class Run:
    """What a lock-step gave. time: s (points,); waves: V of every saved node; stats: seconds, cycles, time points."""

    stream: bytes
    cycles: Cycle
    time: npt.NDArray[np.float64]
    waves: dict[str, npt.NDArray[np.float64]]
    stats: dict[str, Any]
    attempts: int


def program(sensor: SensorParameters, note: Callable[[str], None] = lambda text: None) -> Path:
    """The compiled lock-step for ``sensor``. Raises ToolError, also where libngspice is missing."""
    if not ctypes.util.find_library(LIBRARY) or not has_headers(["ngspice/sharedspice.h"]):
        raise ToolError("libngspice: not found; install it (Debian: apt-get install libngspice0-dev)")
    sources = [PACKAGE / "pixels" / "afe.sv", HERE / "front_end.sv", FRAME / "bench.sv"]
    build = Build.of(sensor)
    options = [*build.parameters("-G"), "-DAFE=RealAfe"]
    return program_of(build, "Bench", options, sources, HERE / "lockstep.cpp", note, ["-O1", "-lngspice"])


def run(
    binary: Path,
    deck: Callable[[Accuracy], Deck],
    frame: FrameParameters,
    samples: npt.NDArray[np.float64],
    front_end: FrontEnd,
    timing: Timing,
    accuracy: Accuracy,
    whole: bool = False,
    max_cycles: int = 1_000_000,
    note: Callable[[str], None] = lambda text: None,
) -> Run:
    """One frame; where ngspice gives up, again with the next of ``accuracy.ladder``.

    whole: see `RowRequest`. note: called now and then with how far it is. Raises ToolError after the last.
    """
    why = ""
    for attempt, tried in enumerate(accuracy.ladder, 1):
        try:
            return _run(binary, deck(tried), frame, samples, front_end, timing, tried, attempt, whole, max_cycles, note)
        except ToolError as error:
            if f"status {GAVE_UP}" not in str(error):
                raise
            why = str(error)
    raise ToolError(f"ngspice gave up with every setting: {why}")


def _run(
    binary: Path,
    deck: Deck,
    frame: FrameParameters,
    samples: npt.NDArray[np.float64],
    front_end: FrontEnd,
    timing: Timing,
    accuracy: Accuracy,
    attempt: int,
    whole: bool,
    max_cycles: int,
    note: Callable[[str], None],
) -> Run:
    script = host_script([*write_transfers(frame_writes(frame, front_end.trim)), command("start")], [])
    with tempfile.TemporaryDirectory(prefix="talbot-") as name:
        folder = Path(name)
        write_samples(folder / "samples", samples)
        write_converter(folder / "converter", front_end)
        (folder / "deck").write_text("\n".join([*deck.lines, ""]))
        seconds = timing.period, timing.edge, accuracy.step, max_cycles * timing.period, timing.high
        head = " ".join(f"{one:.9g}" for one in seconds)
        (folder / "drive").write_text("\n".join([head, *deck.drive, ""]))
        more = [f"+{file}={folder / file}" for file in ("deck", "drive", "cycles", "points", "lockstep")]
        uic = ["+uic=1"] if deck.flat or any(line.startswith(".ic ") for line in deck.lines) else []
        with _watched(folder / "cycles", note):
            done = run_frame(
                binary,
                folder / "samples",
                folder / "converter",
                script,
                max_cycles=max_cycles,
                more=[*more, f"+answers={','.join(deck.answers)}", *(["+whole=1"] if whole else []), *uic],
            )
        time, waves = _points(folder / "points")
        stats = json.loads((folder / "lockstep").read_text())
        return Run(done.stream, _cycles(folder / "cycles", len(deck.answers)), time, waves, stats, attempt)


@contextlib.contextmanager
def _watched(cycles: Path, note: Callable[[str], None]) -> Iterator[None]:
    """Within it, a line now and then on how many cycles of the circuit the simulation has written."""
    over = threading.Event()

    def watch() -> None:
        while not over.wait(INTERVAL):
            if cycles.exists():
                done = cycles.read_bytes().count(b"\n")
                note(f"{done} cycles of the circuit")

    watcher = threading.Thread(target=watch)
    watcher.start()
    try:
        yield
    finally:
        over.set()
        watcher.join()


def _points(path: Path) -> tuple[npt.NDArray[np.float64], dict[str, npt.NDArray[np.float64]]]:
    head, _, body = path.read_bytes().partition(b"\n")
    names = head.decode().split()
    table = np.frombuffer(body[: len(body) // (8 * len(names)) * 8 * len(names)]).reshape(-1, len(names)).T
    waves = {name.removeprefix("v(").removesuffix(")"): row for name, row in zip(names, table, strict=True)}
    return waves.pop("time"), waves


def _cycles(path: Path, lanes: int) -> Cycle:
    table = np.loadtxt(path, ndmin=2)
    place = table[:, 2].astype(np.int64)
    of_lane = table[:, 3:].reshape(len(table), lanes, 6)
    asked = of_lane[:, :, 1].astype(np.int64)
    flags: Sequence[npt.NDArray[np.bool_]] = [of_lane[:, :, i] != 0 for i in (0, 2, 3)]
    return Cycle(
        table[:, 1].astype(np.int64),
        (place >> 25 & 1) != 0,
        (place >> 24 & 1) != 0,
        place & 255,
        place >> 8 & 7,
        place >> 11 & 3,
        flags[0],
        asked,
        flags[1],
        flags[2],
        of_lane[:, :, 4],
        of_lane[:, :, 5],
    )
