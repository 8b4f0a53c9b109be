"""Frames of every cross of mode, mask, window, overlap, lanes and stall, back to back in the chip's Verilog.

No reset between them; decimation, threshold and phase are random, and so is the order: every frame follows another one.
"""

import random
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np

from talbot.base.tools import ToolError
from talbot.imaging.simulate.build import Build
from talbot.imaging.simulate.frame import STOP, host_script, run_frame
from talbot.imaging.simulate.verilator import bench_program
from talbot.models.afe import write_converter, write_samples
from talbot.models.chip import front_end_of, golden_frame
from talbot.models.digital.host import command, frame_writes, write_transfers
from talbot.models.parameters import MODES, ArrayParameters, ChipParameters, FrameParameters, SensorParameters, Window
from talbot.verif.bench.exposure import FAST, TAPS, TRIMS
from talbot.verif.bench.exposure import SENSOR as SMALL
from talbot.verif.bench.simulation import BenchTest

ARRAYS = {1: ArrayParameters(9, 13), 2: ArrayParameters(10, 23), 8: ArrayParameters(8, 59)}  # by lanes
STALLS = {"none": 0, "some": 100, "most": 230}  # of 256 cycles
MASKS, WINDOWS = ("one type", "some types", "all types"), ("whole array", "part", "one tile")
ALL_TYPES = (1 << 24) - 1


class Cross(NamedTuple):
    """A class of valid frames; masks and windows that leave nothing to read are tests of ReadoutSeq."""

    mode: str
    mask: str
    window: str
    overlap: bool
    lanes: int
    stall: str

    def __str__(self) -> str:
        overlap = "overlap" if self.overlap else "no overlap"
        return f"{self.mode}, {self.mask}, {self.window}, {overlap}, {self.lanes} lanes, stall {self.stall}"


@dataclass(frozen=True)
class Crossed:
    """The simulations of one number of lanes. seen: crosses of their frames, as text."""

    tests: list[BenchTest]
    seen: list[str]


def every() -> set[Cross]:
    """Return all crosses."""
    return {Cross(*values) for values in product(MODES, MASKS, WINDOWS, (False, True), ARRAYS, STALLS)}


def sensor_of(lanes: int) -> SensorParameters:
    """Return the sensor with ``lanes``; its last tiles are not whole."""
    return SensorParameters(array=ARRAYS[lanes], chip=ChipParameters(lanes=lanes), converter=SMALL.converter)


def classify(sensor: SensorParameters, frame: FrameParameters, stall: int) -> Cross:
    """Return the cross of a frame, by its parameters."""
    types, window = frame.mask.bit_count(), frame.window
    tile = (window.row0, window.col0) == (window.row1, window.col1)
    return Cross(
        frame.mode,
        MASKS[(types > 1) + (types == 24)],
        WINDOWS[0 if window == sensor.full_window else 2 if tile else 1],
        frame.overlap,
        sensor.chip.lanes,
        next(name for name, share in STALLS.items() if share == stall),
    )


def frames(lanes: int, seed: int) -> Iterator[FrameParameters]:
    """Yield a frame of each cross with ``lanes``, in random order."""
    rng, sensor = random.Random(f"{lanes} {seed}"), sensor_of(lanes)
    last_row, last_col = sensor.full_window.row1, sensor.full_window.col1
    crosses = list(product(MODES, MASKS, WINDOWS, (False, True)))
    for mode, mask, window, overlap in rng.sample(crosses, len(crosses)):
        row, col = rng.randrange(last_row), rng.randrange(last_col)  # a whole tile, which has every type
        part = Window(row, last_row, col, last_col - 1)
        whole, tile = sensor.full_window, Window(row, row, col, col)
        types = rng.sample(range(24), {"one type": 1, "some types": rng.randint(2, 23), "all types": 24}[mask])
        yield FrameParameters(
            {"whole array": whole, "part": part, "one tile": tile}[window],
            mode,
            mask=sum(1 << t for t in types),
            overlap=overlap,
            timing=FAST,
            threshold=rng.choice((0, 1, 20, 127)),
            decimation=0 if mask == "one type" else rng.randrange(4),
            phase=mode == "tof" and rng.random() < 0.5,
            noise_floor=rng.choice((0, 20, 201, 255)),
            frame_number=rng.randrange(1 << 16),
        )


def crossed(lanes: int, seed: int) -> Crossed:
    """Run the frames of all crosses with ``lanes``: a simulation for each stall."""
    planned, sensor = list(frames(lanes, seed)), sensor_of(lanes)
    return Crossed(
        [
            BenchTest(f"crosses of {lanes} lanes, stall {name}", run(lanes, share, planned))
            for name, share in STALLS.items()
        ],
        [str(classify(sensor, frame, share)) for frame in planned for share in STALLS.values()],
    )


def run(lanes: int, stall: int, planned: Sequence[FrameParameters]) -> str | None:
    """Run frames in one simulation; returns the error of the first wrong one, or None."""
    sensor = sensor_of(lanes)
    rng, shape = np.random.default_rng(lanes), (TAPS, sensor.array.rows, sensor.array.cols)
    samples = rng.uniform(0, 128, (*shape, 1)) + rng.normal(0, 20, (*shape, 2))
    front_end = front_end_of(sensor, TRIMS)
    script = b"".join(
        host_script([*write_transfers(frame_writes(frame, TRIMS)), command("start")], []).removesuffix(STOP)
        for frame in planned
    )
    program = bench_program(Build.of(sensor))
    with tempfile.TemporaryDirectory(prefix="talbot-") as temporary:
        folder = Path(temporary)
        write_samples(folder / "samples", samples)
        write_converter(folder / "converter", front_end)
        try:
            got = run_frame(program, folder / "samples", folder / "converter", script + STOP, stall, 50_000_000).stream
        except ToolError as error:
            return str(error)
    for number, frame in enumerate(planned):
        want = golden_frame(samples, sensor, frame, front_end).stream
        if got[: len(want)] != want:
            return f"frame {number} = {classify(sensor, frame, stall)}: its bytes are not the golden chip's: {frame}"
        got = got[len(want) :]
    return f"{len(got)} bytes follow the last frame" if got else None
