"""From photocurrent to the samples of the analog front end, in SI units, with noise."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.models.digital.exposure import integration_cycles
from talbot.models.parameters import (
    ELEMENTARY_CHARGE,
    AmpTiming,
    ElectricalParameters,
    ParameterError,
    check_int,
    check_real,
)

from .shot import photon_count

NOISE_MAX = 100.0
PHOTONS_MAX = 1e15  # electrons per diode and interval: far beyond any well


@dataclass(frozen=True)
class Exposure:
    """Exposure of the array.

    Attributes
    ----------
    electrical : ElectricalParameters
        Photodiodes and amplifiers.
    timing : AmpTiming
        Integration times, common-mode resets, lead of the reset pointer.
    f_clk : float
        System clock, 1e3..1e9 Hz.
    noise : float
        Factor on the physical noise of every kind, 0..100; 0 is none, 1 physical.
    seed : int
        Seed of the fixed pattern and of the temporal noise, 0..2**32-1; the two use separate random streams.
    """

    electrical: ElectricalParameters
    timing: AmpTiming
    f_clk: float = 10e6
    noise: float = 1.0
    seed: int = 1

    def __post_init__(self) -> None:
        check_real("f_clk", self.f_clk, 1e3, 1e9)
        check_real("noise", self.noise, 0, NOISE_MAX)
        check_int("seed", self.seed, 0, 2**32 - 1)

    @property
    def intervals(self) -> tuple[float, ...]:
        """Seconds of each integration; a common-mode reset is between any two."""
        return tuple(cycles / self.f_clk for cycles in integration_cycles(self.timing))

    def generator(self, stream: int) -> np.random.Generator:
        """Random generator of one stream.

        Parameters
        ----------
        stream : int
            Number of the stream, 0 or more.

        Returns
        -------
        numpy.random.Generator
            In its initial state.
        """
        return np.random.default_rng([self.seed, stream])


def expose(
    pair: npt.NDArray[np.floating], exposure: Exposure, balance: npt.ArrayLike | None = None, tap: int = 0
) -> npt.NDArray[np.floating]:
    """Integrate photocurrents to diode pairs ready for conversion.

    Each of n_cm + 1 intervals, of which the first contains the lead of the reset pointer, adds photocurrent and dark
    current with shot noise, up to the full well. Each reset between them removes the charge that both diodes have in
    common, so that the difference a - g b of a whole exposure survives where the wells would overflow, and leaves kT/C
    noise. Read noise, the offsets of pixels and columns and the columns' 1/f noise are added once, at the end.

    Parameters
    ----------
    pair : float32 or float64 (2, rows, cols)
        Relative photocurrents, 0 or more (1 = a diode of a flat white scene).
    exposure : Exposure
        Times, electrical parameters and noise.
    balance : array (rows, cols), optional
        Capacitor ratio g of every pixel in the common-mode reset; None is 1 everywhere.
    tap : int
        Sub-frame of a time-of-flight frame, 0..3, or another frame of the same chip, 4..99; each has its own noise.

    Returns
    -------
    array (rows, cols, 2)
        In LSB of an 8-bit sum, type of ``pair``: a + b = 255 where both wells are full. Noise may exceed 0..255; the
        converter clips.

    Raises
    ------
    ParameterError
        For a wrong shape, or a value that is negative or not finite.
    """
    if pair.ndim != 3 or pair.shape[0] != 2 or not pair.min() >= 0 or not np.isfinite(pair.max()):
        raise ParameterError(f"pair = {pair.dtype} {pair.shape}: must be (2, rows, cols), finite and not negative")
    e, n = exposure.electrical, exposure.noise
    dtype = pair.dtype
    fixed, moving = exposure.generator(0), exposure.generator(1 + tap)

    def _normal(generator: np.random.Generator, rms: float) -> Any:
        """Draws of this RMS, or 0: the streams are separate, so that skipping one changes no other."""
        return generator.standard_normal(pair.shape, dtype) * dtype.type(rms * n) if rms and n else dtype.type(0)

    gain = np.maximum(1 + _normal(fixed, e.gain_fpn), 0)
    offset = _normal(exposure.generator(101), e.offset_fpn)
    current = pair * dtype.type(e.white_current / ELEMENTARY_CHARGE) * gain + dtype.type(
        e.dark_current / ELEMENTARY_CHARGE
    )

    resets = exposure.generator(301 + tap)
    g = dtype.type(1) if balance is None else np.asarray(balance, dtype)
    wells = np.zeros_like(pair)
    for number, seconds in enumerate(exposure.intervals):
        mean = np.minimum(current * dtype.type(seconds), dtype.type(PHOTONS_MAX))
        if number:
            common = np.minimum(wells[0] / g, wells[1])
            wells[0] -= g * common
            wells[1] -= common
            wells += _normal(resets, e.ktc_noise)
        collected = mean
        if n:
            shot = photon_count(mean, moving.standard_normal(pair.shape, dtype)) - mean
            collected = np.maximum(mean + dtype.type(n) * shot, 0)
        np.clip(wells + collected, 0, dtype.type(e.full_well), out=wells)
    wells += offset + _normal(exposure.generator(201 + tap), e.read_noise)
    if n:
        wells += _columns(exposure, tap, pair.shape).astype(dtype)
    return np.ascontiguousarray(np.moveaxis(wells / dtype.type(e.lsb_electrons), 0, -1))


def _columns(exposure: Exposure, tap: int, shape: tuple[int, ...]) -> npt.NDArray[np.float64]:
    """Offset and 1/f noise of the columns' amplifiers in electrons, (2, rows, cols)."""
    e, (_, rows, cols) = exposure.electrical, shape
    offset = exposure.generator(401).standard_normal((2, 1, cols)) * e.column_fpn
    white = np.fft.rfft(exposure.generator(501 + tap).standard_normal((2, 2 * rows, cols)), axis=1)
    shape_ = 1 / np.sqrt(np.maximum(np.arange(rows + 1), 1))  # power falls with 1/f; a frame sees half of the record
    gain = np.sqrt(2 * rows / (2 * np.sum(shape_[1:-1] ** 2) + shape_[0] ** 2 + shape_[-1] ** 2))
    pink = np.fft.irfft(white * (shape_ * gain)[:, None], 2 * rows, axis=1)[:, :rows]
    return exposure.noise * (offset + pink * e.flicker_noise)
