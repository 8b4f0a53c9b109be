"""One frame through the compiled bench: files in (samples, converter, host script), stream and status out."""

import json
import tempfile
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

from base.tools import ToolError, finish

WAIT, TRANSFER, STOP = b"\x01", b"\x02", b"\x00"


@dataclass(frozen=True)
class FrameRun:
    """stream: bytes that left the chip. miso: bytes that came back over SPI.
    activity: cycles that each pin of the front end was high (bench.sv).
    cycles: clock cycles of the simulation, SPI included. seconds: wall clock of the clock loop (Icarus: of its process).
    """

    stream: bytes
    miso: bytes
    activity: dict
    cycles: int
    seconds: float


def host_script(before, after):
    """The host's script: SPI transfers ``before`` the frame, the wait for its end, transfers ``after`` it.

    before, after: sequences of bytes, each one transfer of 1..255 bytes.
    """

    def transfers(items):
        return b"".join(TRANSFER + bytes([len(item)]) + item for item in items)

    return transfers(before) + WAIT + transfers(after) + STOP


def run_frame(program, samples, converter, script, stall=0, max_cycles=1_000_000_000, waves=None, more=()):
    """Run the bench ``program`` (an executable, or .vvp of Icarus) on one frame; returns FrameRun.

    samples, converter: files of the analog front end (pixels/README.md). script: bytes of `host_script`.
    stall: the link is not ready in this many of 256 cycles. waves: (file, first row, last row) for a VCD.
    more: further arguments of the program.
    Raises ToolError when the bench does not finish.
    """
    simulator = ["vvp"] if Path(program).suffix == ".vvp" else []
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        folder = Path(folder)
        (folder / "script").write_bytes(script)
        arguments = [f"+{name}={folder / name}" for name in ("script", "miso", "stream", "activity", "stats")]
        arguments += [f"+samples={samples}", f"+converter={converter}", f"+stall={stall}", f"+max_cycles={max_cycles}"]
        if waves:
            arguments += [f"+waves={waves[0]}", f"+waves_row0={waves[1]}", f"+waves_row1={waves[2]}"]
        start = perf_counter()
        result = finish([*simulator, program, *arguments, *more])
        spent = perf_counter() - start
        if result.returncode or not (folder / "activity").exists():
            tail = (result.stdout + result.stderr).strip()[-800:]
            raise ToolError(
                f"the simulation stopped with status {result.returncode}"
                f"{' (no frame end)' if result.returncode == 4 else ''}: {tail}"
            )
        activity = json.loads((folder / "activity").read_text())
        stats = folder / "stats"
        seconds = json.loads(stats.read_text())["seconds"] if stats.exists() else spent
        return FrameRun(
            (folder / "stream").read_bytes(), (folder / "miso").read_bytes(), activity, activity.pop("cycles"), seconds
        )
