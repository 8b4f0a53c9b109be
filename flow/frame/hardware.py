"""A frame through the Verilog of the whole chip: samples and configuration -> stream and the chip's own status."""

import tempfile
from dataclasses import dataclass
from pathlib import Path

from flow.simulate import bench_program, run_frame
from flow.simulate.frame import host_script
from flow.simulate.verilator import Build
from models.afe import write_converter, write_samples
from models.digital.host import command, decode_status, frame_writes, status_transfers, write_transfers


@dataclass(frozen=True)
class HardwareFrame:
    """stream: bytes that left the chip. status: its counters and flags, by name.
    activity: cycles that each pin of the front end was high.
    cycles: simulated, host included. seconds: of the clock loop.
    """

    stream: bytes
    status: dict
    activity: dict
    cycles: int
    seconds: float


def build_of(sensor, taps=1, waves=False):
    """What to elaborate for ``sensor``."""
    return Build(
        rows=sensor.array.rows,
        cols=sensor.array.cols,
        lanes=sensor.chip.lanes,
        divider=sensor.chip.divider,
        n_frac=sensor.chip.n_frac,
        iterations=sensor.chip.cordic_iterations,
        tile_rows=sensor.tile.rows,
        tile_cols=sensor.tile.cols,
        taps=taps,
        waves=waves,
    )


def program(sensor, taps, waves=False, note=lambda text: None):
    """The compiled bench for ``sensor`` and frames of ``taps`` sub-frames, 1 or 4."""
    return bench_program(build_of(sensor, taps, waves), note)


def simulate(binary, sensor, frame, samples, front_end, stall=0, waves=None, more=()):
    """Run one frame; returns HardwareFrame.

    samples: (taps, rows, cols, 2), what the amplifier reads. front_end: its converters and trims.
    waves: (file, first row, last row), with a binary built for it.
    more: arguments of the program. Raises ToolError.
    """
    after = status_transfers()
    script = host_script(write_transfers(frame_writes(frame, front_end.trim)) + [command("start")], after)
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        analog, converter = Path(folder) / "samples", Path(folder) / "converter"
        write_samples(analog, samples)
        write_converter(converter, front_end)
        run = run_frame(binary, analog, converter, script, stall=stall, waves=waves, more=more)
    replies, end = [], len(run.miso)
    for transfer in reversed(after):
        replies.insert(0, run.miso[end - len(transfer) : end])
        end -= len(transfer)
    return HardwareFrame(run.stream, decode_status(replies), run.activity, run.cycles, run.seconds)
