"""Bring-up of a chip by its host: digital tests at the pins, then the sensor in the dark and before a lamp.

docs/bring-up.md has the order, what to expect and what a wrong value means.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from talbot.models.afe import trim_codes
from talbot.models.chip import golden_frame
from talbot.models.digital.host import frame_values
from talbot.models.digital.pattern import PatternEnd
from talbot.models.digital.stream import decode_stream
from talbot.models.parameters import MODES, SHORT_TIMING, AmpTiming, FrameParameters, SensorParameters
from talbot.models.pixel import measured_gains
from talbot.models.pixel.trim import optical_gains
from talbot.rtl.host.driver import Code, Host, HostError

Bytes = Callable[[FrameParameters, Sequence[int]], bytes]  # of a frame with these trims, from the chip or its model
Codes = npt.NDArray[np.float64]
PATTERNS = 0x55, 0xAA
FULL, NOISE = 250, 0.3  # code of a full well; by which a noise may be off, relative
TRIM_STEPS = 12  # by which a trim may be off that of the optics


class Figure(NamedTuple):
    """A measured value and the range that a sound chip has."""

    name: str
    value: float
    least: float
    most: float

    @property
    def passes(self) -> bool:
        """Return whether the value is in its range."""
        return self.least <= self.value <= self.most


def digital(host: Host, sensor: SensorParameters, limit: float) -> list[str]:
    """Test a chip whose analog pins may be open; returns the names of the steps.

    limit: of a frame, in the unit of the host's clock. Raises HostError at the first step that fails.
    """
    host.identify()
    registers(host)
    host.loop_back(bytes((*PATTERNS, 0x00, 0xFF)), limit)
    for mode in MODES:
        pattern_frame(host, sensor, mode, limit)
    return ["identity", "registers", "loop-back", *(f"test pattern, {mode}" for mode in MODES)]


def registers(host: Host) -> None:
    """Write the durations with two patterns and read them back. Raises HostError READ_BACK, REFUSED."""
    durations = [f for f in host.chip.configuration if f.key in AmpTiming.__dataclass_fields__ and f.width == 16]
    for pattern in PATTERNS:
        host.configure({f.key: pattern << 8 | pattern for f in durations})
    host.configure({})


def pattern_frame(host: Host, sensor: SensorParameters, mode: str, limit: float) -> None:
    """Compare a frame of the test pattern, and its counters, with the golden chip's. Raises HostError."""
    frame = FrameParameters(sensor.full_window, mode, test_pattern=True, timing=SHORT_TIMING)
    golden = golden_frame(np.zeros(0), sensor, frame, PatternEnd(*sensor.shape, sensor.tile))
    host.configure(frame_values(frame))
    sent, expected = host.frame(limit), golden.stream
    if sent != expected:
        pairs = enumerate(zip(sent, expected, strict=False))
        place = next((n for n, (a, b) in pairs if a != b), min(len(sent), len(expected)))
        raise HostError(Code.LINK, f"test pattern, {mode}: byte {place} must be the golden chip's")
    counters, counts = host.counters(), {"conversions_made": golden.made, "conversions_left_out": golden.left_out}
    if wrong := {name: counters[name] for name, count in counts.items() if counters[name] != count}:
        raise HostError(Code.READ_BACK, f"{wrong}: must be {counts}")


def dark(frames: Bytes, sensor: SensorParameters, raw: FrameParameters) -> list[Figure]:
    """Measure two raw frames without light: level and noise of both diodes, codes of half an LSB of a sum."""
    first, second = _raw(frames, sensor, raw)
    e, code = sensor.electrical, sensor.electrical.lsb_electrons / 2
    rms = float(np.sqrt(e.offset_fpn**2 + e.column_fpn**2 + e.read_noise**2)) / code
    clipped = rms / float(np.sqrt(2 * np.pi))  # mean of a normal value about 0 of which the negative half is 0
    levels = [
        Figure(f"dark level of diode {d}, codes", float(first[..., k].mean()), clipped / 3, 3 * clipped + 0.5)
        for k, d in enumerate("ab")
    ]
    return [*levels, Figure("pixels that change in the dark, share", float((first != second).mean()), 0.05, 0.8)]


def flat(frames: Bytes, sensor: SensorParameters, raw: FrameParameters) -> tuple[list[Figure], list[int]]:
    """Measure two raw frames of a lamp before white paper, at about half a full well; returns the trims, too.

    The light's noise gives the electrons of a code, the mean of both diodes of a type its trim.
    """
    first, second = _raw(frames, sensor, raw)
    e, code = sensor.electrical, sensor.electrical.lsb_electrons / 2
    mean = float(first.mean())
    variance = float((first - second).var()) / 2 - (e.read_noise / code) ** 2 - 1 / 12
    trims = trim_codes(measured_gains(first, sensor.tile))
    off = float(np.abs(trims - trim_codes(optical_gains(sensor.tile, sensor.optics))).max())
    per_code = mean / variance if variance > 0 else np.inf
    columns = first.mean(0)  # of one type each: differences of neighbours of the same type
    uneven = float((columns[sensor.tile.cols :] - columns[: -sensor.tile.cols]).std() / 2**0.5)
    return [
        Figure("flat level, codes", mean, 60, 200),
        Figure("full wells, share", float((first > FULL).mean()), 0, 0.001),
        Figure("electrons of a raw code", per_code, (1 - NOISE) * code, (1 + NOISE) * code),
        Figure("columns differ by, codes rms", uneven, 0, 2 * e.column_fpn / code + 0.3),
        Figure("trims off those of the optics, steps", off, 0, TRIM_STEPS),
    ], [int(trim) for trim in trims]


def silent(
    frames: Bytes, sensor: SensorParameters, edge: FrameParameters, trims: Sequence[int], most: float
) -> list[Figure]:
    """Measure an edge frame of the same light: the share of pixels that are sent. most: of it."""
    samples = decode_stream(frames(edge, trims), sensor.tile)[0].samples
    return [Figure(f"silent pixels sent at {edge.threshold}, share", float((samples != 0).mean()), 0, most)]


def _raw(frames: Bytes, sensor: SensorParameters, raw: FrameParameters) -> tuple[Codes, Codes]:
    """Two raw frames, (rows, cols, 2)."""
    none = [0] * sensor.tile.n_types
    first, second = (decode_stream(frames(raw, none), sensor.tile)[0].samples.astype(float) for _ in range(2))
    return first, second
