"""A frame through the Verilog of the whole chip: samples and configuration -> stream and the chip's own status."""

import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.imaging.simulate.build import Build
from talbot.imaging.simulate.frame import FrameRun, Waves, host_script, run_frame
from talbot.imaging.simulate.running import Running, running
from talbot.imaging.simulate.verilator import bench_program
from talbot.models.afe import FrontEnd, sample_words, write_converter, write_samples
from talbot.models.digital.host import command, decode_status, frame_writes, status_transfers, write_transfers
from talbot.models.parameters import FrameParameters, SensorParameters


@dataclass(frozen=True)
class HardwareFrame(FrameRun):
    """A run of the bench and the chip's ``status``: its counters and flags, by name."""

    status: dict[str, Any]


def program(sensor: SensorParameters, waves: str = "", note: Callable[[str], None] = lambda text: None) -> Path:
    """Return the compiled bench for ``sensor``. waves: as of Build. Raises ToolError."""
    return bench_program(Build.of(sensor, waves), note)


def simulate(
    binary: Path,
    sensor: SensorParameters,
    frame: FrameParameters,
    samples: npt.NDArray[np.float64],
    front_end: FrontEnd,
    stall: int = 0,
    waves: Waves | None = None,
    more: Sequence[str] = (),
) -> HardwareFrame:
    """Run one frame.

    samples: (taps, rows, cols, 2), what the amplifier reads. front_end: its converters and trims. waves: with a binary
    built for them. stall, more: see `run_frame`. Raises ToolError.
    """
    after = status_transfers()
    script = host_script(write_transfers(frame_writes(frame, front_end.trim)) + [command("start")], after)
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        analog, converter = Path(folder) / "samples", Path(folder) / "converter"
        write_samples(analog, samples)
        write_converter(converter, front_end)
        run = run_frame(binary, analog, converter, script, stall=stall, waves=waves, more=more)
    return _with_status(run, after)


class Chip:
    """The chip in one running simulation (see `chip`): its registers stay from frame to frame."""

    def __init__(self, bench: Running) -> None:
        self._bench = bench
        self._written: dict[int, int] = {}

    def frame(
        self, frame: FrameParameters, samples: npt.NDArray[np.float64], trims: Sequence[int]
    ) -> Callable[[], HardwareFrame]:
        """Send the next frame; of its configuration what the chip does not have yet is written.

        samples: (taps, rows, cols, 2), of as many taps as `chip` was given. Returns what waits for the frame's end,
        which raises ToolError where the simulator ends before.
        """
        values = dict(frame_writes(frame, trims))
        new = {address: byte for address, byte in values.items() if self._written.get(address) != byte}
        self._written, after = values, status_transfers()
        run = self._bench.frame(sample_words(samples), [*write_transfers(new.items()), command("start")], after)
        return lambda: _with_status(run.result(), after)


@contextmanager
def chip(program: Path, front_end: FrontEnd, taps: int, stall: int = 0) -> Iterator[Chip]:
    """Start the bench ``program`` with the converters of ``front_end``; frame n has the noise of their seed + n.

    taps: of every frame, 1 or 4. Raises ToolError.
    """
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        converter = Path(folder) / "converter"
        write_converter(converter, front_end)
        with running(program, converter, taps, stall) as bench:
            yield Chip(bench)


def _with_status(run: FrameRun, after: Sequence[bytes]) -> HardwareFrame:
    """Return the run with the bytes of the transfers ``after`` its frame at the end of its SPI bytes."""
    replies, end = [], len(run.miso)
    for transfer in reversed(after):
        replies.insert(0, run.miso[end - len(transfer) : end])
        end -= len(transfer)
    return HardwareFrame(**vars(run), status=decode_status(replies))
