"""Fit pixel types, aperture and chief ray to a sweep by least squares, without access to the true optics.

The sum of a pair is 2 A(theta) omega and tells the ray's angle by its Gaussian; the ratio of difference and sum is
q = m cos(beta (theta_x cos gamma + theta_y sin gamma) + alpha), and the light, A and omega fall out of it.
"""

from typing import Any, NamedTuple

import numpy as np

from talbot.models.calibrate.calibration import VIGNETTING, Calibration
from talbot.models.calibrate.sweep import Floats, Sweep
from talbot.models.calibrate.table import ROUGH, Samples, tables
from talbot.models.parameters import ParameterError, PixelType

BETA_MAX = 50.0
STEP = 2.0  # rad of response per rad of angle, of the first search for a grating
DARK = 0.02  # of the brightest sum: what is below does not count
INTERPOLATED = 400  # samples of a table, at most
SEARCHED = 600  # samples, at most about twice
CERTAIN = 4.0  # standard deviations below which a modulation is none
TILTED = 3.0  # the same of the exit pupil's power


class Pupil(NamedTuple):
    """Aperture and chief ray.

    sigma: of the aperture in rad.
    axis: (2,), tangents (y, x) of the chief ray at the array's middle.
    slope: of its tangents, 1 / px; 0 where it is less than its error.
    slope_error: standard deviation of the slope.
    condition: of the normal equations, columns of length 1.
    """

    sigma: float
    axis: Floats
    slope: float
    slope_error: float
    condition: float


class TypeFit(NamedTuple):
    """A pixel type as measured.

    kind: beta, gamma, alpha, m; beta and m are 0 where no modulation is seen.
    m_error, alpha_error: standard deviations; alpha's in rad, pi where no modulation is seen.
    residual: RMS of q that the fit leaves.
    condition: of the normal equations, columns of length 1.
    beta_error, gamma_error: standard deviations, gamma's in degrees; BETA_MAX and 180 where no modulation is seen.
    """

    kind: PixelType
    m_error: float
    alpha_error: float
    residual: float
    condition: float
    beta_error: float = BETA_MAX
    gamma_error: float = 180.0


def fit_pupil(sweep: Sweep) -> Pupil:
    """Aperture and chief ray from the sums of the pairs.

    sweep: of the bench. Returns Pupil: as measured. Raises ParameterError for a sweep without light.
    """
    sums = np.nanmean(sweep.diodes.sum(-1), 2)  # (n, blocks): the types' own differences are in none
    places = np.nanmean(sweep.places, 1)
    top = float(sums.max())
    if not top > 0:
        raise ParameterError(f"diodes = {top:g} at most: must have light")
    weight = 1 / np.sqrt(np.maximum(sums, 0.01 * top))  # of shot noise
    across = np.ptp(places, 0).max() > 0

    def _rest(p: Floats) -> Floats:
        nu = sweep.holes[:, None] + p[2:4] + p[4] * places
        theta = np.arctan(nu)
        dimmed = (1 + (nu**2).sum(-1)) ** (-VIGNETTING / 2)
        light = top * np.exp(p[0] - (theta**2).sum(-1) / (2 * np.exp(2 * p[1]))) * dimmed
        return ((light - sums) * weight).ravel()

    def _all(p: Floats) -> Floats:
        return np.r_[_rest(p), 0 if across else p[4]]  # of one block: no slope is seen

    from scipy.optimize import least_squares  # imported where it is needed: it is slow

    fitted = least_squares(_all, np.array([0.0, np.log(0.3), 0, 0, 0]), x_scale=[1, 1, 1, 1, 1e-3])
    errors, condition = _errors(fitted.jac, fitted.fun)
    slope, error = float(fitted.x[4]), float(errors[4])
    seen = across and slope > TILTED * error
    sigma = float(np.clip(np.exp(fitted.x[1]), 0.01, 10))
    return Pupil(sigma, fitted.x[2:4], slope if seen else 0.0, error, condition)


def fit_types(sweep: Sweep, pupil: Pupil) -> list[TypeFit]:
    """Every pixel type from the ratios of difference and sum.

    sweep: of the bench. pupil: of the same sweep. Returns list of TypeFit: in the order of the tile; a type without
    pixels or light has no modulation.
    """
    return [_fit_type(sweep, pupil, number) for number in range(sweep.places.shape[1])]


def calibrated(sweep: Sweep, pitch: float, centred: bool = False) -> tuple[Calibration, Pupil, list[TypeFit]]:
    """Quantities fitted to a sweep.

    sweep: of the bench. pitch: of the pixels in m. centred: whether the angles' zero is that of the holes, not that of
    the light's sums. Returns tuple of Calibration, Pupil, list of TypeFit: what is kept, and what it is from.
    """
    pupil = fit_pupil(sweep)
    rays = pupil._replace(axis=np.zeros(2)) if centred else pupil
    fits = fit_types(sweep, rays)
    centre = None
    if pupil.slope:
        y, x = (float(-tangent / pupil.slope) for tangent in pupil.axis)
        centre = y, x
    kinds = tuple(fit.kind for fit in fits)
    if np.median([fit.residual for fit in fits]) > ROUGH:
        kinds = tables(kinds, [_plain(sweep, rays, number) for number in range(len(kinds))], pupil.sigma)
    gains = tuple(float(gain) for gain in sweep.gains)
    return Calibration(kinds, gains, pupil.sigma, pupil.slope / pitch, centre), pupil, fits


def _seen(sweep: Sweep, pupil: Pupil, number: int) -> tuple[Floats, Floats]:
    """Angles (y, x) of the rays that a type was lit by, (n, 2), and its diodes' signals, (n, 2)."""
    diodes, places = sweep.diodes[:, :, number], sweep.places[:, number]
    is_seen = np.isfinite(places).all(1)
    diodes, places = diodes[:, is_seen], places[is_seen]
    if not pupil.slope and is_seen.any():  # all blocks see the same rays
        diodes, places = diodes.mean(1, keepdims=True), places[:1]
    sums = diodes.sum(-1)
    theta = np.arctan(sweep.holes[:, None] + pupil.axis + pupil.slope * places)
    seen = sums > DARK * np.nanmax(sums, initial=0)  # not those that were not measured, NaN
    return theta[seen], diodes[seen]


def _plain(sweep: Sweep, pupil: Pupil, number: int) -> Samples:
    """Return a type's signals without aperture and vignetting."""
    theta, diodes = _seen(sweep, pupil, number)
    some = slice(None, None, -(-len(theta) // INTERPOLATED) or 1)
    theta, diodes = theta[some], diodes[some]
    dimmed = (1 + (np.tan(theta) ** 2).sum(1)) ** (-VIGNETTING / 2)
    light = dimmed * np.exp(-(theta**2).sum(1) / (2 * pupil.sigma**2))
    return Samples(theta, diodes / light[:, None], np.sqrt(light))


def _fit_type(sweep: Sweep, pupil: Pupil, number: int) -> TypeFit:
    theta, diodes = _seen(sweep, pupil, number)
    if len(theta) < 5:
        return TypeFit(PixelType(0, 0, 0, 0.0), 1.0, np.pi, 1.0, 1.0)
    sums = diodes.sum(-1)
    q, weight = (diodes[:, 0] - diodes[:, 1]) / sums, np.sqrt(sums)
    weight = weight / weight.mean()
    first = _nearest_wave(q, theta, weight)

    def _parts(p: Floats) -> tuple[Floats, Floats]:
        turn = theta @ p[:2]
        return np.cos(turn), np.sin(turn)

    def _rest(p: Floats) -> Floats:
        cosine, sine = _parts(p)
        return (p[2] * cosine - p[3] * sine - q) * weight

    def _slopes(p: Floats) -> Floats:
        cosine, sine = _parts(p)
        by_turn = -p[2] * sine - p[3] * cosine
        return np.stack([by_turn * theta[:, 0], by_turn * theta[:, 1], cosine, -sine], 1) * weight[:, None]

    from scipy.optimize import least_squares

    jacobian: Any = _slopes  # SciPy's stubs know none but strings
    fitted = least_squares(_rest, first, jacobian, x_scale=[10, 10, 1, 1])
    errors, condition = _errors(fitted.jac, fitted.fun)
    residual = float(np.sqrt(np.mean((fitted.fun / weight) ** 2)))
    y, x, c, s = fitted.x
    m, m_error = float(np.hypot(c, s)), float(max(errors[2:]))
    if not m > CERTAIN * m_error or not 0 < np.hypot(y, x) <= BETA_MAX:
        return TypeFit(PixelType(0, 0, 0, 0.0), m_error, np.pi, residual, condition)
    alpha = float(np.arctan2(s, c))
    if _unlike(y, x, alpha) > _unlike(-y, -x, -alpha):  # the same wave
        y, x, alpha = -y, -x, -alpha
    kind = PixelType(float(np.hypot(y, x)), float(np.rad2deg(np.arctan2(y, x))), alpha, min(m, 1.0))
    spread = float(max(errors[:2]))
    return TypeFit(
        kind, m_error, m_error / m, residual, condition, spread, min(float(np.rad2deg(spread / kind.beta)), 180.0)
    )


def _unlike(y: float, x: float, alpha: float) -> float:
    """Return the distance of a wave's name from the thesis's types: alpha of 0 or pi/2, gamma of -67.5 to 90."""
    return float(-np.cos(alpha - np.pi / 4) - 0.5 * np.cos(np.arctan2(y, x) - np.deg2rad(11.25)))


def _nearest_wave(q: Floats, theta: Floats, weight: Floats) -> Floats:
    """Angular frequency (y, x), cosine and sine parts of the wave on a grid that explains most."""
    some = slice(None, None, max(len(q) // SEARCHED, 1))  # of all blocks and holes
    q, theta, weight = q[some], theta[some], weight[some]
    side = np.arange(-BETA_MAX, BETA_MAX + STEP, STEP)
    y, x = (grid.ravel() for grid in np.meshgrid(side, side[side >= 0], indexing="ij"))
    inside = (np.hypot(y, x) <= BETA_MAX) & (np.hypot(y, x) > 0)
    k = np.stack([y, x], 1)[inside]
    best, chosen = -np.inf, np.zeros(4)
    for part in np.array_split(k, max(len(k) * len(q) // 1_000_000, 1)):
        turn = part @ theta.T
        cosine, sine = np.cos(turn) * weight, -np.sin(turn) * weight
        cc, ss, cs = (cosine**2).sum(1), (sine**2).sum(1), (cosine * sine).sum(1)
        qc, qs = cosine @ (q * weight), sine @ (q * weight)
        scale = np.maximum(cc * ss - cs**2, 1e-9 * (cc + ss) ** 2)  # a wave of less than a period is hardly two
        c, s = (ss * qc - cs * qs) / scale, (cc * qs - cs * qc) / scale
        power = c * qc + s * qs
        here = int(np.argmax(power))
        if power[here] > best:
            best, chosen = power[here], np.array([*part[here], c[here], s[here]])
    return chosen


def _errors(jacobian: Floats, residual: Floats) -> tuple[Floats, float]:
    """Standard deviations of a fit's parameters, and the condition of its normal equations, columns of length 1."""
    length = np.linalg.norm(jacobian, axis=0)
    length = np.where(length > 0, length, 1)
    u = np.linalg.svd(jacobian / length, full_matrices=False)
    values = np.maximum(u.S, 1e-9 * u.S.max())
    spread = np.sqrt(((u.Vh / values[:, None]) ** 2).sum(0))
    noise = np.sqrt((residual**2).sum() / max(len(residual) - len(length), 1))
    return noise * spread / length, float((values[0] / values[-1]) ** 2)
