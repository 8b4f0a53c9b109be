"""The lock-step program, compiled and run: one row through the chip's Verilog and a circuit."""

import contextlib
import ctypes.util
import json
import tempfile
import threading
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.base.paths import PACKAGE
from talbot.base.tools import ToolError
from talbot.base.verilator import has_headers
from talbot.imaging.simulate.build import Build
from talbot.imaging.simulate.frame import host_script, run_frame
from talbot.imaging.simulate.verilator import FRAME, program_of
from talbot.models.afe import FrontEnd, write_converter, write_samples
from talbot.models.digital.host import command, frame_writes, write_transfers
from talbot.models.parameters import FrameParameters, SensorParameters
from talbot.verif.cosim.accuracy import Accuracy
from talbot.verif.cosim.deck import Deck, Timing

HERE = Path(__file__).parent
GAVE_UP = 5  # exit status where ngspice gives up
INTERVAL = 10.0  # s between two lines on how far a row is
LIBRARY = "ngspice"
Waves = tuple[npt.NDArray[np.float64], dict[str, npt.NDArray[np.float64]]]  # s; V of every saved node


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
    """Result of a lock-step. time: s (points,); waves: V of every saved node; stats: seconds, cycles, time points."""

    stream: bytes
    cycles: Cycle
    time: npt.NDArray[np.float64]
    waves: dict[str, npt.NDArray[np.float64]]
    stats: dict[str, Any]
    attempts: int


def program(sensor: SensorParameters, note: Callable[[str], None] = lambda text: None) -> Path:
    """Return the compiled lock-step for ``sensor``. Raises ToolError, also where libngspice is missing."""
    if not ctypes.util.find_library(LIBRARY) or not has_headers(["ngspice/sharedspice.h"]):
        raise ToolError("libngspice: not found; install it (Debian: apt-get install libngspice0-dev)")
    sources = [PACKAGE / "pixels" / "afe.sv", HERE / "front_end.sv", FRAME / "bench.sv"]
    build = Build.of(sensor)
    options = [*build.parameters("-G"), "-DAFE=RealAfe"]
    return program_of(build, "Bench", options, sources, HERE / "lockstep.cpp", note, ["-O1", "-lngspice"])


def run(
    binary: Path,
    decks: Callable[[Accuracy], Sequence[Deck]],
    frame: FrameParameters,
    samples: npt.NDArray[np.float64],
    front_end: FrontEnd,
    timing: Timing,
    accuracy: Accuracy,
    max_cycles: int = 1_000_000,
    note: Callable[[str], None] = lambda text: None,
) -> Run:
    """Run a frame; where ngspice fails, again with the next of ``accuracy.ladder``.

    decks: the parts of the circuit. note: called now and then with how far it is. Raises
    ToolError after the last.
    """
    why = ""
    for attempt, tried in enumerate(accuracy.ladder, 1):
        try:
            return _run(*(binary, decks(tried), frame, samples, front_end, timing, tried, attempt, max_cycles, note))
        except ToolError as error:
            if f"status {GAVE_UP}" not in str(error):
                raise
            why = str(error)
    raise ToolError(f"ngspice gave up with every setting: {why}")


def _run(
    binary: Path,
    decks: Sequence[Deck],
    frame: FrameParameters,
    samples: npt.NDArray[np.float64],
    front_end: FrontEnd,
    timing: Timing,
    accuracy: Accuracy,
    attempt: int,
    max_cycles: int,
    note: Callable[[str], None],
) -> Run:
    script = host_script([*write_transfers(frame_writes(frame, front_end.trim)), command("start")], [])
    with tempfile.TemporaryDirectory(prefix="talbot-") as name:
        folder = Path(name)
        write_samples(folder / "samples", samples)
        write_converter(folder / "converter", front_end)
        seconds = timing.period, timing.edge, accuracy.step, max_cycles * timing.period, timing.high
        head = " ".join(f"{one:.9g}" for one in seconds)
        for k, deck in enumerate(decks):
            (folder / f"deck.{k}").write_text("\n".join([*deck.lines, ""]), encoding="utf-8")
            (folder / f"drive.{k}").write_text(
                "\n".join([f"{head} {','.join(deck.answers)}", *deck.drive, ""]), encoding="utf-8"
            )
        begun = any(deck.flat or any(line.startswith(".ic ") for line in deck.lines) for deck in decks)
        more = [f"+{file}={folder / file}" for file in ("deck", "drive", "cycles", "points", "lockstep")]
        more += [f"+parts={len(decks)}", *(["+uic=1"] if begun else [])]
        with _watched(folder / "cycles.0", note):
            done = run_frame(
                *(binary, folder / "samples", folder / "converter", script), max_cycles=max_cycles, more=more
            )
        parts = [_points(folder / f"points.{k}", deck.lanes) for k, deck in enumerate(decks)]
        spent = [json.loads((folder / f"lockstep.{k}").read_text(encoding="utf-8")) for k in range(len(decks))]
        stats = spent[0] | {"seconds": max(one["seconds"] for one in spent)}
        stats |= {name: sum(one[name] for one in spent) for name in ("processor_seconds", "accepted", "rejected")}
        cycles = [_cycles(folder / f"cycles.{k}", len(deck.answers)) for k, deck in enumerate(decks)]
        together = replace(cycles[0], volts=np.sum([one.volts for one in cycles], 0))  # 0 of another part's lanes
        return Run(done.stream, together, *_merged(parts), stats, attempt)


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


def _points(path: Path, lanes: Sequence[int]) -> Waves:
    """Time and waves of a part; its reference by the names of its ``lanes``."""
    head, _, body = path.read_bytes().partition(b"\n")
    names = head.decode().split()
    table = np.frombuffer(body[: len(body) // (8 * len(names)) * 8 * len(names)]).reshape(-1, len(names)).T
    waves = {name.removeprefix("v(").removesuffix(")"): row for name, row in zip(names, table, strict=True)}
    reference = waves.pop("ref")
    return waves.pop("time"), waves | {f"ref{lane}": reference for lane in lanes}


def _merged(parts: Sequence[Waves]) -> Waves:
    """Waves of all ``parts`` at the time points of any."""
    if len(parts) == 1:
        return parts[0]
    time = np.unique(np.concatenate([time for time, _ in parts]))
    return time, {name: np.interp(time, own, wave) for own, waves in parts for name, wave in waves.items()}


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
