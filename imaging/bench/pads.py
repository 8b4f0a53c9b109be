"""From volts at the test chip's pads to what its diodes collect: followers, linearity, dark current.

A diode is at the reset level under reset. Its charge, in volts of the capacitance that it then has, is
x + bend x**2 after a fall of x: the junction's capacitance rises as the diode discharges.
"""

from collections import Counter
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from talbot.imaging.bench.readings import Floats, Readings
from talbot.models.parameters import ParameterError
from talbot.pixels.test_chip.places import COLS, ROWS

SIDES = "a", "b"
DEGREE = 4  # of a transfer, at most two less than its levels
LEVELS = 3  # of a reset sweep, at least
STRAIGHT = 0.5  # V below the highest level: over which followers have their gain
FOLLOWING = 0.2, 1.2  # V at a pad for each V at the diode; a follower outside is broken
EDGE = 0.005  # V beyond the sweep
TIMES = 3  # exposures of one diode at one angle, at least, for the linearity
RATIO = 2.0  # of the longest to the shortest of them
APART = 2.0  # K between temperatures
NEAR = 5.0  # K between light and the nearest dark readings


class Figure(NamedTuple):
    """A measured value and its standard error, None where it cannot be measured."""

    value: float
    error: float | None

    @classmethod
    def mean(cls, values: Floats) -> "Figure | None":
        """Return the mean of values, NaN left out; None of none."""
        values = values[np.isfinite(values)]
        if not values.size:
            return None
        error = float(values.std(ddof=1) / np.sqrt(values.size)) if values.size > 1 else None
        return cls(float(values.mean()), error)


@dataclass(frozen=True, eq=False)
class Followers:
    """Transfer from diode to pad, (rows, cols, 2) each.

    curves: (rows, cols, 2, 5) coefficients of the diode's V by the pad's, rising powers. low, high: V at the pad, of
    the sweep. gain: V at the pad for each V at the diode. offset: V at the pad at the level ``middle``, mean of all.
    residual: V rms at the diode. broken: pixels whose pads do not follow.
    """

    curves: Floats
    low: Floats
    high: Floats
    gain: Floats
    offset: Floats
    residual: float
    middle: float
    broken: tuple[tuple[int, int], ...]

    def diode(self, row: Floats, col: Floats, pads: Floats) -> Floats:
        """Return V at the diodes from V at the pads (n, 2); NaN outside the sweep."""
        at = row.astype(int), col.astype(int)
        inside = (pads >= self.low[at] - EDGE) & (pads <= self.high[at] + EDGE)
        volts = sum(self.curves[at][..., k] * pads**k for k in range(DEGREE + 1))
        return np.where(inside, volts, np.nan)


def followers_of(readings: Readings) -> Followers:
    """Fit the reset sweeps. A diode without one has the mean transfer. Raises ParameterError."""
    sweep = readings.of("sweep")
    if not len(sweep):
        raise ParameterError("kind = sweep: must be on lines of at least one pixel (reset level against pads)")
    shape = ROWS, COLS, len(SIDES)
    curves, low, high = np.full((*shape, DEGREE + 1), np.nan), np.full(shape, np.nan), np.full(shape, np.nan)
    gain, offset, residuals, broken = np.full(shape, np.nan), np.full(shape, np.nan), [], []
    middle = float(np.unique(sweep["vdda_v"]).mean())
    for row, col in _pixels(sweep):
        part = sweep.where((sweep["row"] == row) & (sweep["col"] == col))
        level = part["vdda_v"]
        count = len(np.unique(level))
        if count < LEVELS:
            raise ParameterError(
                f"vdda_v = {count} levels ({part.places[0]}): must be at least {LEVELS} in the sweep of pixel "
                f"{row},{col}"
            )
        straight = level >= min(level.max() - STRAIGHT, np.unique(level)[-2])
        for side, name in enumerate(SIDES):
            pad = part[f"{name}0_v"]
            slope = np.polyfit(level[straight], pad[straight], 1)
            if not FOLLOWING[0] < slope[0] < FOLLOWING[1]:
                broken.append((row, col))
                continue
            at = row, col, side
            fit = np.polynomial.Polynomial.fit(pad, level, min(DEGREE, count - 2))
            curves[at] = np.pad(fit.convert().coef, (0, DEGREE))[: DEGREE + 1]
            low[at], high[at] = pad.min(), pad.max()
            gain[at], offset[at] = slope[0], np.interp(middle, *_sorted(level, pad))
            residuals.append(fit(pad) - level)
    if not residuals:
        raise ParameterError(f"a0_v, b0_v = sweep of {len(sweep)} lines: must follow the reset level at some pixel")
    for values in (curves, low, high):
        mean = np.nanmean(values, (0, 1, 2))
        values[np.isnan(values)] = np.broadcast_to(mean, values.shape)[np.isnan(values)]
    residual = float(np.sqrt(np.mean(np.concatenate(residuals) ** 2)))
    return Followers(curves, low, high, gain, offset, residual, middle, tuple(sorted(set(broken))))


@dataclass(frozen=True, eq=False)
class Collected:
    """Falls of the diodes of dark and light readings. start, end: (n, 2) V below the reset level, NaN outside."""

    readings: Readings
    start: Floats
    end: Floats

    @classmethod
    def of(cls, readings: Readings, followers: Followers) -> "Collected":
        """Return the falls of the dark and light lines."""
        both = readings.of("dark", "light")
        pads = [np.stack([both[f"{side}{k}_v"] for side in SIDES], 1) for k in (0, 1)]
        volts = [followers.diode(both["row"], both["col"], pad) for pad in pads]
        vdda = both["vdda_v"][:, None]
        return cls(both, vdda - volts[0], vdda - volts[1])

    def rates(self, bend: float) -> Floats:
        """Return what the diodes collect in V/s at the reset level's capacitance, (n, 2)."""
        charge = self.end - self.start + bend * (self.end**2 - self.start**2)
        return charge / self.readings["seconds"][:, None]

    @cached_property
    def bend(self) -> Figure | None:
        """The capacitance's rise, 1/V, from light readings of one diode and angle at several times; None without."""
        lit = self.readings.kind == "light"
        names = "row", "col", "outer_deg", "inner_deg"
        keys = np.stack([self.readings[name] for name in names], 1)
        _, groups = np.unique(keys[lit], axis=0, return_inverse=True)
        straight, curved = [], []
        for group in np.flatnonzero(np.bincount(groups.ravel()) >= TIMES):
            chosen = np.flatnonzero(lit)[groups.ravel() == group]
            for side in range(len(SIDES)):
                x0, x1 = self.start[chosen, side], self.end[chosen, side]
                time = self.readings["seconds"][chosen]
                seen = np.isfinite(x0 + x1)
                x0, x1, time = x0[seen], x1[seen], time[seen]
                if len(np.unique(time)) < TIMES or time.max() < RATIO * time.min():
                    continue
                weight = 1 / np.sqrt(time)  # of shot noise
                basis = time * weight
                for value, out in ((x1 - x0, straight), (x1**2 - x0**2, curved)):
                    part = value * weight
                    out.append(part - basis * (basis @ part) / (basis @ basis))  # the light is unknown
        if not straight:
            return None
        y, x = -np.concatenate(straight), np.concatenate(curved)
        bend = float(x @ y / (x @ x))
        rest = y - bend * x
        free = max(len(y) - len(straight) - 1, 1)
        return Figure(bend, float(np.sqrt(rest @ rest / free / (x @ x))))


@dataclass(frozen=True, eq=False)
class Dark:
    """Dark rates. celsius: (t,) mean temperatures. rates: (t, rows, cols, 2) V/s, NaN where none was read."""

    celsius: Floats
    rates: Floats

    def near(self, celsius: Floats, row: Floats, col: Floats, places: Readings) -> Floats:
        """Return the dark rates (n, 2) of light readings. Raises ParameterError where none is of that temperature."""
        which = np.abs(celsius[:, None] - self.celsius).argmin(1)
        far = np.flatnonzero(np.abs(celsius - self.celsius[which]) > NEAR)
        if far.size:
            known = ", ".join(f"{t:.1f}" for t in self.celsius)
            raise ParameterError(
                f"celsius = {celsius[far[0]]:g} ({places.places[far[0]]}): must be within {NEAR:g} K of dark readings, "
                f"which are at {known} degrees C"
            )
        usual = np.nanmedian(self.rates, (1, 2, 3))
        rates = self.rates[which, row.astype(int), col.astype(int)]
        return np.where(np.isnan(rates), usual[which][:, None], rates)


def dark_of(collected: Collected, bend: float) -> Dark:
    """Sort the dark readings by temperature. Raises ParameterError without any inside the sweep."""
    chosen = collected.readings.kind == "dark"
    rates = collected.rates(bend)[chosen]
    part = collected.readings.where(chosen)
    usable = np.isfinite(rates).any(1)
    if not usable.any():
        raise ParameterError("kind = dark: must be on lines inside the sweep's range (lamp off, after the reset)")
    celsius = part["celsius"]
    order = np.argsort(celsius, kind="stable")
    number = np.empty(len(order), int)
    number[order] = np.cumsum(np.diff(celsius[order], prepend=celsius[order[0]]) > APART)
    means, tables = [], []
    for k in range(number.max() + 1):
        same = (number == k) & usable
        if same.any():
            means.append(celsius[same].mean())
            tables.append(gathered(part["row"][same], part["col"][same], rates[same]))
    return Dark(np.array(means), np.array(tables))


def gathered(row: Floats, col: Floats, values: Floats, weights: Floats | None = None) -> Floats:
    """Return means (rows, cols, 2) of values (n, 2) by pixel, NaN where there is none."""
    weights = np.ones(len(values)) if weights is None else weights
    sums, counts = np.zeros((ROWS, COLS, 2)), np.zeros((ROWS, COLS, 2))
    good = np.isfinite(values)
    at = row.astype(int), col.astype(int)
    np.add.at(sums, at, np.where(good, values, 0) * weights[:, None])
    np.add.at(counts, at, good * weights[:, None])
    return np.where(counts > 0, sums / np.where(counts > 0, counts, 1), np.nan)


def mean_over(values: Floats, axis: int | tuple[int, ...]) -> Floats:
    """Return the mean of what is finite, NaN where nothing is."""
    count = np.isfinite(values).sum(axis)
    return np.where(count > 0, np.nansum(values, axis) / np.maximum(count, 1), np.nan)


def lost(collected: Collected) -> Counter[tuple[int, int]]:
    """Return the light readings outside the sweep's range, by pixel."""
    part = collected.readings
    outside = (part.kind == "light") & ~np.isfinite(collected.start + collected.end).all(1)
    return Counter((int(row), int(col)) for row, col in zip(part["row"][outside], part["col"][outside], strict=True))


def _pixels(readings: Readings) -> list[tuple[int, int]]:
    pairs = {(int(row), int(col)) for row, col in zip(readings["row"], readings["col"], strict=True)}
    return sorted(pairs)


def _sorted(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    order = np.argsort(x, kind="stable")
    return x[order], y[order]
