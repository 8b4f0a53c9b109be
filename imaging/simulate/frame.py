"""One frame through the compiled bench: files in (samples, converter, host script), stream and status out."""

import json
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

from talbot.base.tools import ToolError, finish

WAIT, TRANSFER, STOP = b"\x01", b"\x02", b"\x00"
WAVES = ("vcd", "fst")  # formats of waves
NO_FRAME_END = 4  # exit status of the bench


@dataclass(frozen=True)
class FrameRun:
    """Result of a simulation.

    stream: bytes that left the chip. miso: bytes that came back over SPI. activity: cycles that each pin of the front
    end was high, by pin (bench.sv). integrated: cycles that each row of pixels integrated, as its driver sees it.
    cycles: clock cycles of the simulation, SPI included. seconds: wall clock of the clock loop (Icarus: of its
    process).
    """

    stream: bytes
    miso: bytes
    activity: dict[str, int]
    integrated: list[int]
    cycles: int
    seconds: float


@dataclass(frozen=True)
class Waves:
    """Rows whose cycles go to a file of waves, in the format for which the program was built."""

    file: Path
    first_row: int
    last_row: int


def host_script(before: Sequence[bytes], after: Sequence[bytes]) -> bytes:
    """Return the host's script: SPI transfers ``before`` the frame, the wait for its end, transfers ``after`` it.

    Each item is one transfer of 1..255 bytes.
    """
    return transfers(before) + WAIT + transfers(after) + STOP


def transfers(items: Sequence[bytes]) -> bytes:
    """Return the part of a script that plays SPI transfers of 1..255 bytes each."""
    return b"".join(TRANSFER + bytes([len(item)]) + item for item in items)


def simulator(program: Path) -> list[object]:
    """Return the words that start the bench ``program``: an executable, or .vvp of Icarus."""
    return ["vvp", program] if program.suffix == ".vvp" else [program]


def run_frame(
    program: Path,
    samples: Path,
    converter: Path,
    script: bytes,
    stall: int = 0,
    max_cycles: int = 1_000_000_000,
    waves: Waves | None = None,
    more: Sequence[str] = (),
) -> FrameRun:
    """Run the bench ``program`` (an executable, or .vvp of Icarus) on one frame.

    samples, converter: files of the analog front end (pixels/README.md). script: of `host_script`. stall: the link is
    not ready in this many of 256 cycles. more: further arguments of the program. Raises ToolError when the bench does
    not finish.
    """
    with tempfile.TemporaryDirectory(prefix="talbot-") as temporary:
        folder = Path(temporary)
        (folder / "script").write_bytes(script)
        arguments = [f"+{name}={folder / name}" for name in ("script", "miso", "stream", "activity", "stats")]
        arguments += [f"+samples={samples}", f"+converter={converter}", f"+stall={stall}", f"+max_cycles={max_cycles}"]
        if waves:
            arguments += [f"+waves={waves.file}", f"+waves_row0={waves.first_row}", f"+waves_row1={waves.last_row}"]
        start = perf_counter()
        result = finish([*simulator(program), *arguments, *more])
        spent = perf_counter() - start
        if result.returncode or not (folder / "activity").exists():
            reason = " (no frame end)" if result.returncode == NO_FRAME_END else ""
            tail = (result.stdout + result.stderr).strip()[-800:]
            raise ToolError(f"the simulation stopped with status {result.returncode}{reason}: {tail}")
        activity = json.loads((folder / "activity").read_text(encoding="utf-8"))
        integrated = activity.pop("integrated")
        stats = folder / "stats"
        seconds = json.loads(stats.read_text(encoding="utf-8"))["seconds"] if stats.exists() else spent
        stream, miso = (folder / "stream").read_bytes(), (folder / "miso").read_bytes()
        return FrameRun(stream, miso, activity, integrated, activity.pop("cycles"), seconds)
