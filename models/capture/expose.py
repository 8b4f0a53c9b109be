"""Exposure: photocurrent becomes the samples of the analog front end, in SI units, with noise."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from talbot.models.capture.shot import PHOTONS_MAX, Pixels, collect, read
from talbot.models.digital.exposure import integration_cycles
from talbot.models.parameters import (
    ELEMENTARY_CHARGE,
    AmpTiming,
    ElectricalParameters,
    ParameterError,
    check_int,
    check_real,
)

NOISE_MAX = 100.0
SIGMAS = 3.0  # of its noise, by which a well that counts as full may be below a full one
NEAR = 0.5  # of a full well, which that is at most


@dataclass(frozen=True)
class Exposure:
    """Exposure of the array.

    electrical: photodiodes and amplifiers.
    timing: integration times, common-mode resets, lead of the reset pointer.
    f_clk: system clock, 1e3..1e9 Hz.
    noise: factor on the physical noise of every kind, 0..100; 0 is none, 1 physical.
    seed: seed of the fixed pattern and of the temporal noise, 0..2**32-1; the two use separate random streams.
    number: of the exposure in a sequence, 0..2**32-1: each has independent temporal noise.
    """

    electrical: ElectricalParameters
    timing: AmpTiming
    f_clk: float = 10e6
    noise: float = 1.0
    seed: int = 1
    number: int = 0

    def __post_init__(self) -> None:
        check_real("f_clk", self.f_clk, 1e3, 1e9)
        check_real("noise", self.noise, 0, NOISE_MAX)
        check_int("seed", self.seed, 0, 2**32 - 1)
        check_int("number", self.number, 0, 2**32 - 1)

    @property
    def intervals(self) -> tuple[float, ...]:
        """Seconds of each integration; a common-mode reset is between any two."""
        return tuple(cycles / self.f_clk for cycles in integration_cycles(self.timing))

    def generator(self, stream: int) -> np.random.Generator:
        """Random generator of a stream of temporal noise.

        stream: number of the stream, 0 or more. Returns numpy.random.Generator: in its initial state.
        """
        return np.random.default_rng([self.seed, stream, self.number])


class _Pattern(NamedTuple):
    """The fixed pattern of a chip: the diodes, and the offsets of the columns in electrons."""

    pixels: Pixels
    columns: npt.NDArray[np.float64]


@lru_cache(maxsize=2)  # with noise and without
def _fixed_pattern(
    electrical: ElectricalParameters, noise: float, seed: int, shape: tuple[int, ...], dtype: np.dtype[Any]
) -> _Pattern:
    e = electrical

    def _normal(stream: int, rms: float) -> Any:
        return np.zeros(shape, dtype) + _draw(np.random.default_rng([seed, stream]), shape, dtype, rms * noise)

    columns = np.random.default_rng([seed, 401]).standard_normal((2, 1, shape[2])) * e.column_fpn
    gain = np.maximum(1 + _normal(0, e.gain_fpn), 0)
    light, dark = e.white_current / ELEMENTARY_CHARGE, e.dark_current / ELEMENTARY_CHARGE
    numbers = [light, dark, e.full_well, e.lsb_electrons, noise, e.read_noise * noise, PHOTONS_MAX]
    return _Pattern(Pixels(gain, _normal(101, e.offset_fpn), np.array(numbers, dtype)), columns)


def _draw(generator: np.random.Generator, shape: tuple[int, ...], dtype: np.dtype[Any], rms: float) -> Any:
    """Normal draws of this RMS, or 0: the streams are separate, so that skipping one changes no other."""
    return generator.standard_normal(shape, dtype) * dtype.type(rms) if rms else dtype.type(0)


def expose(
    pair: npt.NDArray[np.floating], exposure: Exposure, balance: npt.ArrayLike | None = None, tap: int = 0
) -> npt.NDArray[np.floating]:
    """Integrate photocurrents to diode pairs ready for conversion.

    Each of n_cm + 1 intervals, of which the first contains the lead of the reset pointer, adds photocurrent and dark
    current with shot noise, up to the full well. Each reset between them removes the charge that both diodes have in
    common, so that the difference a - g b of a whole exposure survives where the wells would overflow, and leaves kT/C
    noise. Read noise, the offsets of pixels and columns and the columns' 1/f noise are added once, at the end.

    pair: (2, rows, cols), relative photocurrents, 0 or more (1 = a diode of a flat white scene). exposure: times,
    electrical parameters and noise. balance: (rows, cols), capacitor ratio g of every pixel in the common-mode reset;
    None is 1 everywhere. tap: sub-frame of a time-of-flight frame, 0..3, or another frame of the same chip, 4..99; each
    has its own noise. Returns (rows, cols, 2), in LSB of an 8-bit sum, type of ``pair``: a + b = 255 where both wells
    are full. Noise may exceed 0..255; the converter clips. Raises ParameterError for a wrong shape, or a value that is
    negative or not finite.
    """
    if pair.ndim != 3 or pair.shape[0] != 2 or not pair.min() >= 0 or not np.isfinite(pair.max()):
        raise ParameterError(f"pair = {pair.dtype} {pair.shape}: must be (2, rows, cols), finite and not negative")
    e, n = exposure.electrical, exposure.noise
    dtype = pair.dtype
    pixels, columns = _fixed_pattern(e, n, exposure.seed, pair.shape, dtype)
    none = np.empty((0, 0, 0), dtype)
    *_, wells = _filled(pair, exposure, pixels, balance, tap)
    z, pink = none, np.empty((0, 0, 0))
    if n:
        z = exposure.generator(201 + tap).standard_normal(pair.shape, dtype) if e.read_noise else none
        pink = _flicker(exposure, tap, pair.shape)
    out = np.empty((*pair.shape[1:], 2), dtype)
    read(out, wells, pixels, z, pink, e.flicker_noise, columns, n)
    return out


def full_wells(
    pair: npt.NDArray[np.floating], exposure: Exposure, balance: npt.ArrayLike | None = None
) -> npt.NDArray[np.bool_]:
    """Tell pixels one of whose wells is full at the end of an interval, or may be with its noise.

    Their sum and difference are those of the wells, not of the light.

    pair, exposure, balance: as in `expose`. Returns (rows, cols), True where a well without noise reaches a full one
    less `SIGMAS` of shot noise and gain, at most `NEAR` of it.
    """
    e, clear = exposure.electrical, replace(exposure, noise=0.0)
    near = min(SIGMAS * exposure.noise * float(np.hypot(1 / np.sqrt(e.full_well), e.gain_fpn)), NEAR)
    pixels, _ = _fixed_pattern(e, 0.0, exposure.seed, pair.shape, pair.dtype)
    out = np.zeros(pair.shape[1:], bool)
    for wells in _filled(pair, clear, pixels, balance, 0):
        out |= (wells >= (1 - near) * e.full_well).any(0)
    return out


def _filled(
    pair: npt.NDArray[np.floating], exposure: Exposure, pixels: Pixels, balance: npt.ArrayLike | None, tap: int
) -> Iterator[npt.NDArray[np.floating]]:
    """Electrons at the end of every interval, before the reset after it; the same array (2, rows, cols)."""
    dtype, noise = pair.dtype, exposure.noise
    moving, resets = exposure.generator(1 + tap), exposure.generator(301 + tap)
    pair, none = np.ascontiguousarray(pair), np.empty((0, 0, 0), dtype)
    g = dtype.type(1) if balance is None else np.asarray(balance, dtype)
    wells = np.zeros(pair.shape, dtype)
    for number, seconds in enumerate(exposure.intervals):
        if number:
            common = np.minimum(wells[0] / g, wells[1])
            wells[0] -= g * common
            wells[1] -= common
            wells += _draw(resets, pair.shape, dtype, exposure.electrical.ktc_noise * noise)
        z = moving.standard_normal(pair.shape, dtype) if noise else none
        collect(wells, pair, pixels, dtype.type(seconds), z)
        yield wells


def _flicker(exposure: Exposure, tap: int, shape: tuple[int, ...]) -> npt.NDArray[np.float64]:
    """1/f noise of the columns' amplifiers, RMS 1, (2, 2 rows, cols): of a frame the first half."""
    _, rows, cols = shape
    white = np.fft.rfft(exposure.generator(501 + tap).standard_normal((2, 2 * rows, cols)), axis=1)
    shape_ = 1 / np.sqrt(np.maximum(np.arange(rows + 1), 1))  # power falls with 1/f; a frame sees half of the record
    gain = np.sqrt(2 * rows / (2 * np.sum(shape_[1:-1] ** 2) + shape_[0] ** 2 + shape_[-1] ** 2))
    white *= (shape_ * gain)[:, None]
    return np.fft.irfft(white, 2 * rows, axis=1)
