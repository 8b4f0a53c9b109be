"""Pictures before the sensor, one frame each, through the golden chip: codes, bytes and energy; some by the Verilog."""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from talbot.base.kept import kept
from talbot.imaging.frame import hardware
from talbot.imaging.frame.figures import golden_events, image_mode, mismatches
from talbot.imaging.frame.job import diodes_of, numbered, trimmed
from talbot.imaging.frame.request import FrameRequest, request
from talbot.models.afe import FrontEnd
from talbot.models.chip import GoldenFrame, golden_frame
from talbot.models.digital.exposure import slot_cycles
from talbot.models.parameters import EnergyParameters, SensorParameters
from talbot.models.recognition.optics import Display, phase_types

STREAMS = 100  # frames whose bytes and energy are measured
CHUNK = 250  # pictures that are kept together


@dataclass(frozen=True)
class Reading:
    """Frames of pictures as the chip sends them.

    codes: (n, rows, cols), 0 where it does not read. bytes: of a frame, mean. energy: in J, mean, lower and higher
    reading. share: of the samples, that are not 0. image_energy: with every sample converted and sent as a byte.
    """

    codes: npt.NDArray[np.int16]
    bytes: float
    energy: tuple[float, float]
    share: float
    image_energy: tuple[float, float]


def sized(display: Display) -> SensorParameters:
    """Return the sensor with the array that the display's picture fills."""
    rows, cols = display.size
    sensor = display.sensor
    return replace(sensor, array=replace(sensor.array, rows=rows, cols=cols))


def frame_request(display: Display, mode: str, threshold: int, noise: float, seed: int) -> FrameRequest:
    """Return the frame of a picture. mode: edge, ternary or image; the first two read the types of alpha 0 alone."""
    if mode == "image":
        return request(sensor=sized(display), mode=mode, noise=noise, seed=seed)
    mask = sum(1 << int(kind) for kind in phase_types(display.sensor))
    return request(sensor=sized(display), mode=mode, threshold=threshold, mask=mask, noise=noise, seed=seed)


def read(
    display: Display, pictures: npt.NDArray[np.float32], mode: str, threshold: int, noise: float, seed: int
) -> Reading:
    """Read one frame of each of ``pictures`` (n, height, width), linear radiance, by the golden chip.

    The temporal noise differs from frame to frame; the fixed pattern does not. Raises ParameterError.
    """
    setup = frame_request(display, mode, threshold, noise, seed)
    front_end = kept("recognize_trims", trimmed, setup)
    parts = [
        kept("recognize", _frames, setup, front_end, display, pictures[i : i + CHUNK], i)
        for i in range(0, len(pictures), CHUNK)
    ]
    codes = np.concatenate([part[0] for part in parts])
    size, low, high, image_low, image_high = parts[0][1].mean(0)
    read_share = (setup.frame.mask.bit_count() / display.sensor.tile.n_types) if mode != "image" else 1.0
    share = float((codes[:STREAMS] != 0).mean() / read_share)
    return Reading(codes, float(size), (float(low), float(high)), share, (float(image_low), float(image_high)))


def samples_of(
    setup: FrameRequest, front_end: FrontEnd, display: Display, pictures: npt.NDArray[np.float32], first: int = 0
) -> list[tuple[npt.NDArray[np.float64], FrontEnd]]:
    """Return the samples and converters of every frame; ``pictures[0]`` is frame ``first``."""
    return [
        (diodes_of(setup, pair[None], front_end, first + i), numbered(front_end, setup.sensor, first + i))
        for i, pair in enumerate(display.currents(pictures))
    ]


def _frames(
    setup: FrameRequest, front_end: FrontEnd, display: Display, pictures: npt.NDArray[np.float32], first: int
) -> tuple[npt.NDArray[np.int16], npt.NDArray[np.float64]]:
    """Codes, and of the first frames (bytes, energies)."""
    codes, figures = [], []
    for i, (samples, converters) in enumerate(samples_of(setup, front_end, display, pictures, first)):
        golden = golden_frame(samples, setup.sensor, setup.frame, converters)
        codes.append(golden.sent[..., 0])
        if first + i < STREAMS:
            figures.append((len(golden.stream), *_energy(golden)))
    return np.stack(codes), np.array(figures).reshape(-1, 5)


def _energy(golden: GoldenFrame) -> tuple[float, float, float, float]:
    """Energy of a frame in J, lower and higher reading, then with every sample converted and sent as a byte."""
    cycles = frame_cycles(golden)
    events = golden_events(golden, golden.stream, cycles, cycles)
    parameters = EnergyParameters()
    return *parameters.total(events), *parameters.total(image_mode(events, golden.samples))


def frame_cycles(golden: GoldenFrame) -> int:
    """Cycles of a frame: a slot for each row, and for each by which the reset pointer leads."""
    timing = golden.frame.exposing
    return (int(golden.read.any(1).sum()) + timing.exposure) * slot_cycles(timing)


def verify(
    display: Display, pictures: npt.NDArray[np.float32], mode: str, threshold: int, noise: float, seed: int
) -> dict[str, int]:
    """Read ``pictures`` by the Verilog as well: bytes, those that differ, and cycles of both. Raises ToolError."""
    setup = frame_request(display, mode, threshold, noise, seed)
    front_end = kept("recognize_trims", trimmed, setup)
    program = hardware.program(setup.sensor)
    out = {"frames": len(pictures), "bytes": 0, "mismatches": 0, "cycles": 0, "cycles_model": 0}
    for samples, converters in samples_of(setup, front_end, display, pictures):
        golden = golden_frame(samples, setup.sensor, setup.frame, converters)
        chip = hardware.simulate(program, setup.sensor, setup.frame, samples, converters)
        out["bytes"] += len(chip.stream)
        out["mismatches"] += mismatches(chip.stream, golden.stream)
        out["cycles"] += chip.status["cycles"]
        out["cycles_model"] += frame_cycles(golden)
    return out
