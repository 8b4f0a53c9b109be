"""The exposure in the benches of the whole chip: a small array and an imperfect front end."""

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.models.afe import write_converter, write_samples
from talbot.models.chip import front_end_of
from talbot.models.parameters import (
    AmpTiming,
    ArrayParameters,
    ChipParameters,
    ConverterParameters,
    FrameParameters,
    SensorParameters,
    Window,
)

TAPS = 4
SENSOR = SensorParameters(
    array=ArrayParameters(9, 13),
    chip=ChipParameters(lanes=2),
    converter=ConverterParameters(inl=2, dnl=0.5, offset=2, noise=1, ktc=0.7, seed=6),
)
FAST = AmpTiming(t_reset=2, t_int=3, t_cm=2, t_settle=2, t_read=2, t_guard=1)
TRIMS = tuple((-1) ** t * (11 * t + 5) for t in range(24))
FRONT_END = front_end_of(SENSOR, TRIMS)


def samples(seed: int = 1) -> npt.NDArray[np.float64]:
    """Return diode pairs (TAPS, rows, cols, 2), some equal, some that differ by more than the converter's range."""
    rng = np.random.default_rng(seed)
    shape = TAPS, SENSOR.array.rows, SENSOR.array.cols
    common = rng.uniform(0, 128, (*shape, 1))
    return common + rng.normal(0, 20, (*shape, 2)) * (rng.random((*shape, 1)) < 0.4)


def write(folder: Path) -> list[str]:
    """Write the front end's files to ``folder``; returns the plusargs that name them."""
    write_samples(folder / "samples", samples())
    write_converter(folder / "converter", FRONT_END)
    return [f"+{name}={folder / name}" for name in ("samples", "converter")]


def frame_of(window: Window = SENSOR.full_window, mode: str = "edge", **fields: Any) -> FrameParameters:
    """Return a frame with short amplifier timing. fields: of FrameParameters."""
    return FrameParameters(window, mode, timing=FAST, **fields)


FRAMES = {
    "edge": frame_of(threshold=9, frame_number=7),
    "every sample": frame_of(threshold=0, overlap=False),
    "ternary": frame_of(mode="ternary", threshold=6),
    "image, some types": frame_of(mode="image", mask=0x8040A1),
    "raw, a window": frame_of(Window(1, 2, 1, 2), "raw"),
    "tof, decimated": frame_of(mode="tof", mask=0x000003, decimation=1),
    "phase": frame_of(Window(1, 1, 0, 2), "tof", mask=0x000F0F, phase=True, noise_floor=20),
    "test pattern": frame_of(test_pattern=True),
}
