"""The test chip on a simulated bench: a lamp, a stage of two angles, a voltmeter, and readings as a user would write.

Sizes that are not measured are assumed and named so.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from talbot.imaging.bench.readings import COLUMNS, Floats, Readings
from talbot.models.calibrate import sunflower
from talbot.models.parameters import (
    ELEMENTARY_CHARGE,
    STANDARD,
    LightParameters,
    PixelType,
    RoomParameters,
    SensorParameters,
    drawn_electrical,
)
from talbot.models.parameters.electrical import BOLTZMANN, PHOTON, TEMPERATURE
from talbot.models.pixel.weights import density
from talbot.pixels.designs import gratings
from talbot.pixels.test_chip.levels import BEND, DIODE_V, FARAD, FEEDTHROUGH, PAD_V
from talbot.pixels.test_chip.places import COLS, COVERED, PLAIN, REFERENCE, ROWS, by_type

TRANSFER = np.polynomial.Polynomial.fit(DIODE_V, PAD_V, 6)
OPENING_UM = 3.57, 6.65  # of the frame above a diode: pixels/layout/pixel.py
SETTLE = 100e-6  # s from the reset's end to the first reading: our choice, several time constants of a pad of 35 pF
VDDA = 2.0
LEVELS = np.arange(13, 22) / 10  # V of the reset sweep
FALL = 0.4  # V that the brightest diode of a pixel falls in an exposure: our choice, of the 0.7 V in the sweep
REACH_DEG = 25.0  # of the stage: f/1.2 accepts 22.6
LONGEST = 1.0  # s of a light exposure
DARK_S = 3.0
WARM = 25.0, 45.0  # degrees C, of dark readings
TIMES, REPEATS = (0.25, 0.5, 0.75, 1.0), 16  # of the plain pixels' exposures on the axis, for the linearity
# Assumed
VOLTMETER, STAGE_DEG, DRIFT = 0.2e-3, 0.02, 0.02  # V rms of a reading; rms; of the lamp over the session, peak
OFFSET, GAIN = 10e-3, 0.002  # rms of the followers
CROSSTALK = 0.004  # of a plain pixel's signal, into a covered one
DOUBLING = 8.0  # K
FILTER_NM, FILTER = 20.0, 0.8  # width and transmission of the lamp's filter


class Lamp(NamedTuple):
    """Light on the chip. irradiance: W/m2, of a beam square to it."""

    irradiance: float
    wavelength_nm: float

    def plain_current(self) -> float:
        """Return A of a plain pixel's diode on the axis."""
        area = 1e-12 * OPENING_UM[0] * OPENING_UM[1]
        photons = self.irradiance * area * 1e-9 * self.wavelength_nm / PHOTON
        return photons * RoomParameters().quantum_efficiency * ELEMENTARY_CHARGE


@dataclass(frozen=True)
class Truth:
    """What a simulation had put in. levels: (types,) mean of both diodes over that of a plain pixel, on the axis."""

    levels: tuple[float, ...]
    crosstalk: float
    dark: tuple[float, ...]
    gain: float
    bend: float


def desk_lamp(lux: float) -> Lamp:
    """White light of ``lux`` on the chip, through a filter at the gratings' wavelength."""
    room, wavelength = RoomParameters(illuminance=lux), 1e3 * gratings("sky130").wavelength_um
    white = room.illuminance / room.efficacy
    return Lamp(white * FILTER * FILTER_NM / 300, wavelength)  # equal energy, 400..700 nm


def stage(tangents: Floats) -> Floats:
    """Return the stage's angles (outer, inner) in degrees for rays of these tangents (y, x)."""
    inner = np.arctan(tangents[:, 0])
    return np.rad2deg(np.stack([np.arctan(tangents[:, 1] * np.cos(inner)), inner], 1))


def tangents_of(outer_deg: Floats, inner_deg: Floats) -> Floats:
    """Return the tangents (y, x) of the light in the chip's frame at these angles of the stage."""
    outer, inner = np.deg2rad(outer_deg), np.deg2rad(inner_deg)
    return np.stack([np.tan(inner), np.tan(outer) / np.cos(inner)], 1)


def relative(sensor: SensorParameters, tangents: Floats) -> Floats:
    """Return photocurrents (n, rows, cols, 2) of all pixels over that of a plain diode on the axis."""
    y, x = tangents.T
    plain = 1 / np.sqrt(1 + x**2 + y**2)  # a beam that the chip stands aslant in
    light = np.empty((len(x), ROWS, COLS, 2))
    light[:, REFERENCE] = plain[:, None, None]
    light[:, REFERENCE, COVERED] *= CROSSTALK
    tile, cosine = sensor.tile, plain**sensor.optics.vignetting_power
    for place, number in enumerate(tile.order):
        kind = tile.types[number]
        row, col = divmod(place, tile.cols)
        response = density((kind,), sensor.optics, x, y)[0] / cosine
        light[:, row, col] = (scale(kind) * plain * response).T
    return light


def scale(kind: PixelType) -> float:
    """Return the response of a type over that of a plain pixel, which has a frame, for a table's or Eq. 3.1's value."""
    if kind.response is None:
        return LightParameters().gratings
    half = (1e6 * 10e-6) ** 2 / 2  # um2: a table is over half of a pixel of 10 um
    return half / (OPENING_UM[0] * OPENING_UM[1])


def exposures(light: Floats, lamp: Lamp) -> Floats:
    """Return the seconds (rows, cols) in which the brightest diode of each pixel falls by `FALL`."""
    brightest = light.max((0, 3)) * lamp.plain_current() / FARAD
    return np.minimum((FALL + BEND * FALL**2) / brightest, LONGEST)


def simulate(
    sensor: SensorParameters, lamp: Lamp, tangents: Floats, noise: float = 1.0, seed: int = 1
) -> tuple[Readings, Truth]:
    """Return a session's readings. noise: times that of voltmeter, light, chip, lamp and stage; 0 is none.

    tangents: (n, 2), of the stage's settings.
    """
    rng = np.random.default_rng(seed)
    chip = _Chip(rng, noise, sensor.electrical.gain_fpn)
    settings = rng.permutation(np.round(stage(tangents), 3))  # in another order than the lamp's drift
    turned = tangents_of(*(settings + noise * rng.normal(0, STAGE_DEG, settings.shape)).T)
    light = relative(sensor, turned)
    seconds = exposures(light, lamp)
    dark = np.array([_dark_volts(t) for t in WARM])
    parts = [chip.sweep()]
    rows, cols = (grid.ravel() for grid in np.indices((ROWS, COLS), float))
    for celsius, rate in zip(WARM, dark, strict=True):
        for _ in range(2):
            parts.append(
                chip.exposed("dark", rows, cols, np.full((ROWS * COLS, 2), rate), DARK_S, {"celsius": celsius})
            )
    full = lamp.plain_current() / FARAD
    lit = {"celsius": WARM[0], "wavelength_nm": lamp.wavelength_nm}
    phase = rng.uniform(0, 2 * np.pi)
    axis = relative(sensor, np.zeros((1, 2)))[0]
    plain = [(share, col) for _ in range(REPEATS) for share in TIMES for col in PLAIN]
    share, col = (np.array(column) for column in zip(*plain, strict=True))
    row = np.full(len(col), REFERENCE)
    rates = chip.gains[row, col] * axis[row, col] * full + dark[0]
    angles = {"outer_deg": 0.0, "inner_deg": 0.0}
    parts.append(chip.exposed("light", row, col, rates, share * seconds[row, col], lit | angles))
    for k, (outer, inner) in enumerate(settings):
        lamps = 1 + noise * DRIFT * np.sin(2 * np.pi * k / len(settings) + phase)
        rates = (chip.gains * light[k]).reshape(-1, 2) * full * lamps + dark[0]
        angles = {"outer_deg": outer, "inner_deg": inner}
        parts.append(chip.exposed("light", rows, cols, rates, seconds.ravel(), lit | angles))
    values = {name: np.concatenate([part[1][name] for part in parts]) for name in COLUMNS}
    kind = np.concatenate([part[0] for part in parts])
    readings = Readings(kind, values, [f"line {i + 2} of the simulation" for i in range(len(kind))])
    levels = by_type(light).mean(2) / light[:, REFERENCE, :1].mean(2)
    gain = float(np.polyfit(LEVELS[-6:], _pad(LEVELS[-6:]), 1)[0])
    return readings, Truth(tuple(levels.mean(0)), CROSSTALK, tuple(dark), gain, BEND)


def angles(holes: int) -> Floats:
    """Return the tangents (n, 2) of the stage's settings, as even in the lens's disc as those of a hole."""
    return sunflower(round(np.pi / 4 * holes**2), float(np.tan(np.deg2rad(REACH_DEG))))


class _Chip:
    """The drawn chip with noise. gains: (rows, cols, 2) of the diodes' light."""

    def __init__(self, rng: np.random.Generator, noise: float, spread: float) -> None:
        shape = ROWS, COLS, 2
        self.rng, self.noise = rng, noise
        self.gains = 1 + noise * rng.normal(0, spread, shape)
        self.offset = noise * rng.normal(0, OFFSET, shape)
        self.slope = 1 + noise * rng.normal(0, GAIN, shape)

    def pads(self, row: Floats, col: Floats, volts: Floats) -> Floats:
        """Return readings (n, 2) of diodes at ``volts``."""
        at = row.astype(int), col.astype(int)
        pad = PAD_V.mean() + (_pad(volts) - PAD_V.mean()) * self.slope[at] + self.offset[at]
        return pad + self.noise * self.rng.normal(0, VOLTMETER, pad.shape)

    def sweep(self) -> tuple[np.ndarray, dict[str, Floats]]:
        """Return the reset sweep of every pixel."""
        number, row, col = (grid.ravel() for grid in np.indices((len(LEVELS), ROWS, COLS), float))
        level = LEVELS[number.astype(int)]
        pads = self.pads(row, col, np.stack([level, level], 1))
        first = {"a0_v": pads[:, 0], "b0_v": pads[:, 1]}
        return _lines("sweep", len(level), {"row": row, "col": col, "celsius": WARM[0], "vdda_v": level} | first)

    def exposed(
        self, kind: str, row: Floats, col: Floats, rates: Floats, seconds: Floats | float, more: dict[str, float]
    ) -> tuple[np.ndarray, dict[str, Floats]]:
        """Return two readings each of exposures. rates: (n, 2) V/s at the reset level's capacitance."""
        seconds = np.broadcast_to(seconds, len(row))
        reset = np.sqrt(BOLTZMANN * TEMPERATURE / FARAD)
        start = _charge(FEEDTHROUGH) + self.noise * self.rng.normal(0, reset, rates.shape)
        start = start + self._collected(rates, SETTLE)
        end = start + self._collected(rates, seconds[:, None])
        pads = [self.pads(row, col, VDDA - fall(charge)) for charge in (start, end)]
        names = {f"{side}{k}_v": pads[k][:, i] for k in (0, 1) for i, side in enumerate("ab")}
        return _lines(kind, len(row), {"row": row, "col": col, "vdda_v": VDDA, "seconds": seconds} | more | names)

    def _collected(self, rates: Floats, seconds: Floats | float) -> Floats:
        electrons = rates * seconds * FARAD / ELEMENTARY_CHARGE
        shot = self.rng.normal(0, 1, rates.shape) * np.sqrt(np.maximum(electrons, 0))
        return (electrons + self.noise * shot) * ELEMENTARY_CHARGE / FARAD


def _lines(kind: str, count: int, values: dict[str, Floats | float]) -> tuple[np.ndarray, dict[str, Floats]]:
    filled = {name: np.broadcast_to(np.asarray(values.get(name, np.nan), np.float64), count) for name in COLUMNS}
    return np.full(count, kind), filled


def _dark_volts(celsius: float) -> float:
    """Return the dark rate in V/s: of the simulated circuit at 25 degrees, doubled every `DOUBLING`."""
    return drawn_electrical(STANDARD.electrical).dark_current / FARAD * 2 ** ((celsius - WARM[0]) / DOUBLING)


def _charge(volts: float) -> float:
    return volts + BEND * volts**2


def fall(charge: Floats) -> Floats:
    """Return V that diodes fall as they collect ``charge``, in V of their capacitance at the reset level."""
    return (np.sqrt(1 + 4 * BEND * np.maximum(charge, -1)) - 1) / (2 * BEND)


def _pad(volts: Floats) -> Floats:
    return TRANSFER(np.clip(volts, DIODE_V[0], DIODE_V[-1]))
