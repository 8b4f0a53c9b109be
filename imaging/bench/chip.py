"""Pixel types, quantum efficiency, dark current and crosstalk of the test chip from readings of its pads."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from talbot.imaging.bench.compare import LEAST, heights_of, orientation
from talbot.imaging.bench.pads import (
    Collected,
    Dark,
    Figure,
    Followers,
    dark_of,
    followers_of,
    gathered,
    lost,
    mean_over,
)
from talbot.imaging.bench.readings import Floats, Readings
from talbot.imaging.bench.simulated import tangents_of
from talbot.models.calibrate import Sweep, TypeFit, calibrated
from talbot.models.calibrate.calibration import VIGNETTING
from talbot.models.parameters import (
    ELEMENTARY_CHARGE,
    STANDARD,
    ParameterError,
    PixelType,
    SensorParameters,
    TileParameters,
    drawn_electrical,
)
from talbot.models.pixel import TableResponse
from talbot.models.pixel.response import response
from talbot.pixels.test_chip.places import COLS, COVERED, PLAIN, REFERENCE, ROWS, by_type

WEAK = 0.02  # of the usual signal of a type: what is below is dead
GRID = 121, 13  # angles of a response that Eq. 3.1 explains
DIRECTIONS = 3  # of the angles: with two, waves of gamma and of -gamma are alike
AXIS = 0.01  # rad from 0, 0 within which an angle has no direction


class Angles(NamedTuple):
    """Signals by angle: tangents (n, 2) of the light, (y, x); rates (n, rows, cols, 2) in V/s, NaN where none is."""

    tangents: Floats
    rates: Floats


@dataclass(frozen=True, eq=False)
class Measured:
    """What a bench has measured.

    fits: of the tile's types. efficiency: of each type against a plain pixel, None where it is not measured.
    responses: of each type, 1 is a plain pixel on the axis. signals: (angles, types, 2) over a plain pixel there.
    """

    sensor: SensorParameters
    followers: Followers
    bend: Figure | None
    dark: Dark
    angles: Angles
    fits: list[TypeFit]
    efficiency: list[Figure | None]
    responses: list[TableResponse]
    signals: Floats
    summary: dict[str, Any]


def measured(readings: Readings, sensor: SensorParameters = STANDARD) -> Measured:
    """Fit everything. sensor: of which the tile has the chip's types. Raises ParameterError."""
    check_tile(sensor.tile)
    wavelength = _wavelength(readings)
    notes: list[str] = []
    followers = followers_of(readings)
    collected = Collected.of(readings, followers)
    bend = collected.bend
    if bend is None:
        notes.append("no diode was read at three exposure times at one angle: its capacitance is taken as constant")
    factor = bend.value if bend else 0.0
    dark = dark_of(collected, factor)
    angles = _angles(collected, dark, factor)
    rates, dead, excluded = _sound(collected, angles, followers)
    notes += excluded
    signals, plain = _relative(angles.tangents, rates, notes)
    theta = np.arctan(angles.tangents)
    calibration, pupil, fits, absent = _fitted(signals, angles.tangents, sensor)
    present = set(range(len(fits))) - absent
    notes += _about(fits, absent, signals, theta)
    types = calibration.types
    efficiency = [_efficiency(signals[:, k], fit, plain, k in absent) for k, fit in enumerate(fits)]
    reach = float(np.abs(theta).max())
    means = mean_over(signals, (0, 2))
    responses = [
        _response(kind, pupil.sigma, reach, theta, signals[:, k] if k not in absent else means[None, sorted(present)])
        for k, kind in enumerate(types)
    ]
    near = int(np.abs(dark.celsius - _mean_celsius(readings)).argmin())
    covered = dark.rates[near, REFERENCE, COVERED]
    dark_rate = Figure.mean(covered if np.isfinite(covered).any() else dark.rates[near])
    electrical = drawn_electrical(STANDARD.electrical)
    farad = electrical.full_well * ELEMENTARY_CHARGE / electrical.swing
    assert dark_rate is not None  # dark_of has refused readings without
    summary: dict[str, Any] = {
        "readings": len(readings),
        "angles": len(angles.tangents),
        "wavelength_nm": wavelength,
        "celsius": _mean_celsius(readings),
        "types": [
            _type(k, fit, efficiency[k], int(np.isfinite(signals[:, k].sum(-1)).sum()), sensor.tile)
            for k, fit in enumerate(fits)
        ],
        "sigma": pupil.sigma,
        "stage_zero_deg": [float(np.rad2deg(np.arctan(-tangent))) for tangent in pupil.axis],
        "follower_gain": _figure(Figure.mean(followers.gain)),
        "follower_offset_v": _figure(Figure.mean(followers.offset)),
        "follower_offset_spread_v": float(np.nanstd(followers.offset)),
        "follower_offset_at_v": followers.middle,
        "follower_residual_v": followers.residual,
        "capacitance_rise": _figure(bend),
        "dark_v_per_s": _figure(dark_rate),
        "dark_current": dark_rate.value * farad,
        "dark_celsius": float(dark.celsius[near]),
        "dark_by_temperature": [
            {"celsius": float(t), "v_per_s": _figure(Figure.mean(rates_))}
            for t, rates_ in zip(dark.celsius, dark.rates, strict=True)
        ],
        "dark_doubling_k": _doubling(dark),
        "capacitance": farad,
        "crosstalk": _figure(_crosstalk(rates)),
        "plain_spread": plain.spread,
        "lamp_rms": plain.lamp_rms,
        "heights": heights_of(signals, angles.tangents, wavelength),
        "condition": max(pupil.condition, *(fit.condition for fit in fits)),
        "dead": [[*pixel] for pixel in dead],
        "notes": notes,
    }
    shown = _as_measured(sensor, types, pupil.sigma, dark_rate.value * farad)
    return Measured(shown, followers, bend, dark, angles, fits, efficiency, responses, signals, summary)


def _sound(
    collected: Collected, angles: Angles, followers: Followers
) -> tuple[Floats, Sequence[tuple[int, int]], list[str]]:
    """Return the rates without those of dead pixels, the dead pixels, and notes on what is left out."""
    dead, rates, notes = _dead(angles, followers), angles.rates.copy(), []
    for row, col in dead:
        rates[:, row, col] = np.nan
        notes.append(f"pixel {row},{col} is left out: its pads do not follow the reset level or the light")
    notes += [
        f"pixel {row},{col}: {count} light readings are outside the reset sweep and are left out; shorten the exposure"
        for (row, col), count in sorted(lost(collected).items())
        if (row, col) not in dead
    ]
    return rates, dead, notes


def _as_measured(
    sensor: SensorParameters, types: Sequence[PixelType], sigma: float, dark_current: float
) -> SensorParameters:
    """Return ``sensor`` with the fitted types, aperture and dark current, each within its range."""
    return replace(
        sensor,
        tile=replace(sensor.tile, types=tuple(replace(kind, response=None) for kind in types)),
        optics=replace(sensor.optics, aperture_sigma=float(np.clip(sigma, 0.01, 10))),
        electrical=replace(sensor.electrical, dark_current=float(np.clip(dark_current, 0, 1e-6))),
    )


def check_tile(tile: TileParameters) -> None:
    """Raise ParameterError unless a tile has the places of the test chip's."""
    if (tile.rows, tile.cols, tile.order) != (REFERENCE, COLS, TileParameters().order):
        raise ParameterError(
            f"tile = {tile.rows} x {tile.cols}: must be the standard's {REFERENCE} x {COLS} in its order, "
            "which the test chip has"
        )


def _wavelength(readings: Readings) -> float:
    lit = readings.of("light")
    if not len(lit):
        raise ParameterError("kind = light: must be on lines of readings")
    other = np.flatnonzero(lit["wavelength_nm"] != lit["wavelength_nm"][0])
    if other.size:
        raise ParameterError(
            f"wavelength_nm = {lit['wavelength_nm'][other[0]]:g} ({lit.places[other[0]]}): must be the same in all "
            f"light readings, {lit['wavelength_nm'][0]:g}; calibrate each wavelength separately"
        )
    return float(lit["wavelength_nm"][0])


def _mean_celsius(readings: Readings) -> float:
    return float(readings.of("light")["celsius"].mean())


def _angles(collected: Collected, dark: Dark, bend: float) -> Angles:
    """Sort the light readings by angle; several of one pixel and angle are averaged, weighted by their fall."""
    lit = collected.readings.kind == "light"
    part = collected.readings.where(lit)
    rates = collected.rates(bend)[lit] - dark.near(part["celsius"], part["row"], part["col"], part)
    settings = np.stack([part["outer_deg"], part["inner_deg"]], 1)
    unique, number = np.unique(settings.round(4), axis=0, return_inverse=True)
    out = np.empty((len(unique), ROWS, COLS, 2))
    for k in range(len(unique)):
        same = number.ravel() == k
        out[k] = gathered(part["row"][same], part["col"][same], rates[same], part["seconds"][same])
    return Angles(tangents_of(*unique.T), out)


def _dead(angles: Angles, followers: Followers) -> list[tuple[int, int]]:
    """Return pixels without signal, or whose pads do not follow."""
    with_light = np.isfinite(angles.rates).any((0, 3))
    means = mean_over(angles.rates, (0, 3))
    dead = set(followers.broken)
    lit = np.zeros((2, ROWS, COLS), bool)  # those with gratings, and the plain ones
    lit[0, :REFERENCE] = True
    lit[1, REFERENCE, PLAIN] = True
    for group in lit:
        chosen = group & with_light
        if chosen.any():
            weak = chosen & (means < WEAK * np.nanmedian(means[chosen]))
            dead |= {(int(row), int(col)) for row, col in np.argwhere(weak)}
    return sorted(dead)


class Plain(NamedTuple):
    """The plain pixels. spread: relative, of their diodes; None of one. lamp_rms: relative, around a smooth curve."""

    spread: float | None
    diodes: int
    lamp_rms: float


def _relative(tangents: Floats, rates: Floats, notes: list[str]) -> tuple[Floats, Plain]:
    """Return the types' signals (angles, types, 2) over a plain pixel's on the axis, the light being 1, and the plain.

    A beam that falls in aslant is cos(theta) thinner. The lamp is that of the plain pixels at the same angle, whose own
    response is smooth.
    """
    diodes = rates[:, REFERENCE, PLAIN].reshape(len(rates), -1)
    diodes = diodes[:, np.isfinite(diodes).any(0)]
    if not diodes.shape[1]:
        raise ParameterError(
            f"row, col = {REFERENCE}, 0, 2 or 4: must have light readings inside the sweep, of a plain pixel"
        )
    level = np.nanmedian(diodes, 0)
    read = np.isfinite(diodes).any(1)
    cosine = 1 / np.sqrt(1 + (tangents**2).sum(1))
    light = mean_over(diodes / level, 1)
    square = np.arccos(np.clip(cosine, 0, 1)) ** 2
    basis = np.stack([np.ones_like(square), square], 1)
    wide = len(np.unique(square[read].round(6))) > 2
    basis = basis if wide else basis[:, :1]
    smooth, *_ = np.linalg.lstsq(basis[read], (light / cosine)[read], rcond=None)
    curve = basis @ smooth
    lamp = np.where(read, light / cosine / curve, 1.0)
    if not read.all():
        notes.append(f"{(~read).sum()} angles have no reading of a plain pixel: the lamp is taken as constant there")
    on_axis = float(level.mean() * smooth[0])
    signals = by_type(rates) / (on_axis * lamp * cosine)[:, None, None]
    spread = float(level.std(ddof=1) / level.mean()) if len(level) > 1 else None
    return signals, Plain(spread, len(level), float(np.sqrt(np.mean((lamp[read] - 1) ** 2))))


def _fitted(signals: Floats, tangents: Floats, sensor: SensorParameters) -> tuple[Any, Any, list[TypeFit], set[int]]:
    """Return calibration, aperture, fits, and the types with too few readings; all types have one level there."""
    good = np.asarray(np.isfinite(signals).all(2))
    absent = {int(k) for k in np.flatnonzero(good.sum(0) < LEAST)}
    present = sorted(set(range(signals.shape[1])) - absent)
    if not present:
        raise ParameterError(
            f"light = at most {good.sum(0).max()} usable angles of a pixel: must be at least {LEAST} inside the sweep"
        )
    whole = np.where(good[..., None], signals, np.nan)
    level = np.ones(signals.shape[1])  # in a mean over types a missing reading of a bright type is none of the lens
    level[present] = mean_over(whole[:, present], (0, 2))
    lens = (1 + (tangents**2).sum(1)) ** (-VIGNETTING / 2)  # of the calibration's model
    diodes = whole / level[:, None] * lens[:, None, None]
    places = np.zeros((1, signals.shape[1], 2))
    for k in absent:
        diodes[:, k], places[:, k] = np.nan, np.nan
    used = np.isfinite(diodes).any((1, 2))
    sweep = Sweep(tangents[used], diodes[used][:, None], places, np.ones(signals.shape[1]))
    calibration, pupil, fits = calibrated(sweep, sensor.array.pitch, centred=True)
    return calibration, pupil, fits, absent


def _response(kind: Any, sigma: float, reach: float, theta: Floats, signals: Floats) -> TableResponse:
    """Return the response of a type over a plain pixel's, by its table or by Eq. 3.1, of the mean of ``signals``."""
    table = kind.response or _formula(kind, sigma, reach)
    good = np.asarray(np.isfinite(signals.reshape(len(signals), -1)).all(1))
    at = theta[good] if len(good) == len(theta) else theta
    return replace(table, values=table.values * float(signals[good].mean() / np.mean(table(at[:, 1], at[:, 0]))))


def _formula(kind: Any, sigma: float, reach: float) -> TableResponse:
    """Return Eq. 3.1 as a table."""
    along, across = np.linspace(-reach, reach, GRID[0]), np.linspace(0, reach, GRID[1])
    tangents = np.tan(np.meshgrid(along, across, indexing="ij"))
    turn = np.cos(kind.gamma), np.sin(kind.gamma)
    x = np.arctan(tangents[0] * turn[0] - tangents[1] * turn[1])
    y = np.arctan(tangents[0] * turn[1] + tangents[1] * turn[0])
    m = kind.m or 0.0
    values = [response(kind.alpha + half, kind.beta, kind.gamma, x, y, m, sigma) for half in (0.0, np.pi)]
    return TableResponse(along, across, np.array(values), kind.gamma, "BENCH")


def _efficiency(signals: Floats, fit: TypeFit, plain: Plain, absent: bool) -> Figure | None:
    """Return a type's mean over that of a plain pixel, which is smooth, over all angles."""
    sums = signals.mean(1)
    sums = sums[np.isfinite(sums)]
    if absent or not sums.size:
        return None
    of_plain = (plain.spread or 0.0) / np.sqrt(plain.diodes)
    return Figure(float(sums.mean()), float(sums.mean() * np.hypot(of_plain, fit.residual / np.sqrt(sums.size))))


def _crosstalk(rates: Floats) -> Figure | None:
    """Return the light signal of covered pixels over that of plain ones at the same angles."""
    plain = mean_over(rates[:, REFERENCE, PLAIN], (1, 2))
    return Figure.mean(mean_over(rates[:, REFERENCE, COVERED].reshape(len(rates), -1) / plain[:, None], 0))


def _doubling(dark: Dark) -> float | None:
    """Return the kelvins in which the dark current doubles, of the mean over all diodes; None of one temperature."""
    means = np.nanmean(dark.rates, (1, 2, 3))
    if len(means) < 2 or means.min() <= 0:
        return None
    slope = float(np.polyfit(dark.celsius, np.log2(means), 1)[0])
    return 1 / slope if slope > 0 else None


def directions(theta: Floats) -> int:
    """Return in how many directions, to a degree, the angles (n, 2) lie from 0, 0."""
    y, x = theta[np.hypot(*theta.T) > AXIS].T
    return len(np.unique(np.round(np.rad2deg(np.arctan2(y, x))) % 180))


def _about(fits: Sequence[TypeFit], absent: set[int], signals: Floats, theta: Floats) -> list[str]:
    """Return lines about types that were not measured, and about angles that look turned."""
    notes = []
    if absent:
        notes.append(
            f"types {', '.join(map(str, sorted(absent)))} have fewer than {LEAST} usable readings: m = 0, not measured"
        )
    none = [k for k, fit in enumerate(fits) if k not in absent and fit.kind.m == 0]
    if none:
        notes.append(f"types {', '.join(map(str, none))} show no modulation: m = 0")
    if (lines := directions(theta)) < DIRECTIONS:
        notes.append(
            f"the angles lie on {lines} lines through 0, 0: gamma is not determined; add angles in another direction"
        )
    turned = orientation(signals, theta)
    if turned:
        notes.append(f"readings agree better with the drawn types with {turned}: check the stage's signs and the pads")
    return notes


def _type(number: int, fit: TypeFit, efficiency: Figure | None, count: int, tile: TileParameters) -> dict[str, Any]:
    kind, place = fit.kind, TileParameters().order.index(number)
    return {
        "row": place // tile.cols,
        "col": place % tile.cols,
        "readings": count,
        **{name: getattr(kind, name) for name in ("beta", "gamma_deg", "alpha", "m")},
        **{name: getattr(fit, name) for name in ("beta_error", "alpha_error", "m_error", "residual", "condition")},
        "gamma_error": fit.gamma_error,
        "efficiency": _figure(efficiency),
    }


def _figure(figure: Figure | None) -> dict[str, float | None] | None:
    return None if figure is None else {"value": figure.value, "error": figure.error}
