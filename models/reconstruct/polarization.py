"""Angle and degree of linear polarization at every pixel, from the common modes of the gratings' orientations.

Around a pixel the light is a plane, and its polarization even:

    i(x) = t + gy dy + gx dx + p cos 2 gamma(x) + q sin 2 gamma(x),    p = -d S1,  q = -d S2

fitted by weighted least squares. The plane takes edges and gradients out of the polarization; pixels across an edge
count less. What stays unexplained is the noise, so that every value comes with its own standard deviation.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from talbot.models.compiled import njit
from talbot.models.parameters import ParameterError, TileParameters, check_int, check_real
from talbot.models.pixel.polarization import angle, stokes
from talbot.models.reconstruct.demosaic import demosaic

Floats = npt.NDArray[np.floating]
REACH = 5  # px from a pixel to the farthest that count
SPREAD = 2.0  # px, sigma of their weights
STEP = 0.12  # of the light: pixels that differ by this much count 1/e**0.5
CERTAIN = 4.0  # standard deviations of the degree below which there is no polarization
TAGGED = 2.0  # the same for a highlight, which must be bright, too
RIDGE = 1e-9  # of the mean weight: bounds the condition of every fit by its inverse
PAIRS = tuple((i, j) for i in range(5) for j in range(i, 5))  # of the fit's columns: 1, dy, dx, cos, sin
ORIENTATIONS = (0.0, 45.0, 90.0, -45.0)  # degrees, of `demosaiced`


class Polarization(NamedTuple):
    """Linear polarization at every pixel.

    light: (rows, cols), S0, in the unit of the samples.
    s1, s2: (rows, cols), S1/S0 and S2/S0, of degree 0..1.
    spread: (rows, cols), standard deviation of S1/S0 and of S2/S0; infinite where the pixel is full or dark, or nothing
        is seen.
    """

    light: Floats
    s1: Floats
    s2: Floats
    spread: Floats

    @property
    def psi(self) -> Floats:
        """Angle of polarization in rad, (-pi/2, pi/2]."""
        return angle(self.s1, self.s2)

    @property
    def degree(self) -> Floats:
        """Degree of linear polarization, 0..1."""
        return np.minimum(np.hypot(self.s1, self.s2), 1)  # rounding may pass it

    @property
    def confidence(self) -> Floats:
        """0..1: 0 where the degree is not CERTAIN."""
        return np.maximum(1 - CERTAIN * self.spread / np.maximum(self.degree, np.finfo(float).tiny), 0)


def demosaiced(sums: Floats, tile: TileParameters, diattenuation: float) -> tuple[Floats, Floats]:
    """S1/S0 and S2/S0 from the four orientations, each interpolated to every pixel: edges become polarization.

    sums: (rows, cols), common mode of every pixel. tile: its types at 0, 45, 90 and -45 degrees count. diattenuation:
    of the gratings, 0.001..1. Returns (rows, cols), S1/S0 and S2/S0, of degree 0..1; 0 where there is no light, or none
    of an orientation. Source: [Jayasuriya2017], Sec. 4.1.
    """
    check_real("diattenuation", diattenuation, 1e-3, 1)
    types = demosaic(np.asarray(sums, float), tile)
    kinds = np.unique(tile.type_map(*sums.shape))
    parts = []
    for degrees in ORIENTATIONS:
        of_direction = [k for k in kinds if abs((tile.types[k].gamma_deg - degrees + 90) % 180 - 90) < 1e-6]
        if not of_direction:
            return np.zeros(sums.shape), np.zeros(sums.shape)
        parts.append(types[of_direction].mean(0))
    i0, i45, i90, i135 = parts
    s1, s2 = stokes(i0, i45, i90, i135, diattenuation)
    excess = np.maximum(np.hypot(s1, s2), 1)
    return s1 / excess, s2 / excess


def polarization(
    sums: Floats,
    tile: TileParameters,
    diattenuation: float,
    noise: Floats | float,
    used: npt.NDArray[np.bool_] | None = None,
    sigma: float = SPREAD,
    passes: int = 2,
) -> Polarization:
    """Polarization at every pixel, corrected for edges.

    sums: (rows, cols), common mode of every pixel, 1 = white. tile: orientation of every type. diattenuation: of the
    gratings, 0.001..1. noise: (rows, cols), standard deviation of a sum that is known before, greater than 0. used:
    (rows, cols), pixels that were read and are not full; None is all. The spread of the others is infinite. sigma: of
    the weights around a pixel, 0.5..10 px. passes: 1..5; each but the first knows the polarization of the one before,
    and so tells an edge from it. Returns finite everywhere. Raises ParameterError for a diattenuation or a noise out of
    range. Source: [Jayasuriya2017], Sec. 4.1 and 4.2: correction for the gradient in a tile.
    """
    check_real("diattenuation", diattenuation, 1e-3, 1)
    check_real("sigma", sigma, 0.5, 10)
    check_int("passes", passes, 1, 5)
    noise = np.broadcast_to(np.asarray(noise, float), sums.shape)
    if not noise.min() > 0:
        raise ParameterError(f"noise = {noise.min():g}: must be greater than 0")
    sums = np.asarray(sums, float)
    used = np.ones(sums.shape, bool) if used is None else used
    turn = 2 * np.array([t.gamma for t in tile.types])[tile.type_map(*sums.shape)]
    cosine, sine = np.cos(turn), np.sin(turn)
    light = s1 = s2 = spread = guide = np.zeros(sums.shape)
    for number in range(passes):
        step = STEP * np.maximum(guide, 0) + 4 * noise if number else np.full(sums.shape, np.inf)
        light, p, q, spread = _fits(sums, cosine, sine, used, guide, step, noise**2, sigma)
        lit = light > noise
        scale = np.where(lit, -1 / (diattenuation * np.where(lit, light, 1)), 0)
        s1, s2 = p * scale, q * scale
        degree = np.hypot(s1, s2)
        s1, s2 = s1 / np.maximum(degree, 1), s2 / np.maximum(degree, 1)
        guide = np.asarray(sums / (1 - diattenuation * (s1 * cosine + s2 * sine) * 0.999))
        spread = np.where(used & lit, np.where(lit, spread, 0) * np.abs(scale), np.inf)
    return Polarization(light, s1, s2, spread)


def specular_tags(polarized: Polarization, threshold: float) -> npt.NDArray[np.bool_]:
    """Where a reflection is seen: as much polarized light as a lamp's mirror image has.

    polarized: full pixels have an infinite spread, and are not tagged. threshold: of the polarized light, 0..16, 1 =
    white. Returns (rows, cols), the tags. Source: [Jayasuriya2017], Sec. 4.2: |I0 - I90| and |I45 - I135| beyond a
    threshold.
    """
    check_real("threshold", threshold, 0, 16)
    return (polarized.degree > TAGGED * polarized.spread) & (polarized.degree * polarized.light > threshold)


def _fits(
    sums: Floats,
    cosine: Floats,
    sine: Floats,
    used: npt.NDArray[np.bool_],
    guide: Floats,
    step: Floats,
    variance: Floats,
    sigma: float,
) -> tuple[Floats, Floats, Floats, Floats]:
    """Light, p, q and the standard deviation of p and q of the fit around every pixel."""
    samples = np.stack([np.where(used, sums, 0), cosine, sine, np.where(used, variance, 0), used.astype(float)])
    totals = np.moveaxis(_moments(samples, guide, 1 / step, sigma), 0, 2)
    normal = np.empty((*sums.shape, 5, 5))
    for number, (i, j) in enumerate(PAIRS):
        normal[..., i, j] = normal[..., j, i] = totals[..., number]
    right, squares, known = totals[..., len(PAIRS) : -2], totals[..., -2], totals[..., -1]
    total = normal[..., 0, 0]
    seen = total > 0
    weight = np.where(seen, total, 1)
    normal[~seen] = 0
    normal += (RIDGE * weight)[..., None, None] * np.eye(5)
    inverse = np.linalg.inv(normal)
    fit = np.einsum("yxij,yxj->yxi", inverse, right)
    residual = np.maximum(squares - np.einsum("yxi,yxi->yx", fit, right), 0)
    free = np.maximum(1 - 5 / weight, 0.2)  # weights are at most 1: there are at least as many samples
    worst = np.maximum(inverse[..., 3, 3], inverse[..., 4, 4])
    spread = np.sqrt(np.maximum(known, residual / free) / weight * worst)
    return fit[..., 0], fit[..., 3], fit[..., 4], np.where(seen, spread, np.inf)


@njit(cache=True, nogil=True)
def _moments(samples: Floats, guide: Floats, sharp: Floats, sigma: float) -> Floats:
    """Weighted sums around every pixel: of `PAIRS` of the fit's columns, of each with the sample, squares, variance.

    samples: sum, cosine, sine, variance, whether used, (5, rows, cols). Result (22, rows, cols).
    """
    rows, cols = guide.shape
    out = np.zeros((22, rows, cols))
    for y in range(rows):
        for v in range(max(y - REACH, 0), min(y + REACH + 1, rows)):
            for dx in range(-REACH, REACH + 1):
                near, b, a = (v - y) ** 2 + dx**2, (v - y) / sigma, dx / sigma
                for x in range(max(-dx, 0), min(cols - dx, cols)):
                    u = x + dx
                    value, c, s, known = samples[0, v, u], samples[1, v, u], samples[2, v, u], samples[3, v, u]
                    away = (guide[v, u] - guide[y, x]) * sharp[y, x]
                    w = samples[4, v, u] * np.exp(-0.5 * (near / sigma**2 + away * away))
                    wc, ws, wi = w * c, w * s, w * value
                    out[0, y, x] += w
                    out[1, y, x] += w * b
                    out[2, y, x] += w * a
                    out[3, y, x] += wc
                    out[4, y, x] += ws
                    out[5, y, x] += w * b * b
                    out[6, y, x] += w * b * a
                    out[7, y, x] += wc * b
                    out[8, y, x] += ws * b
                    out[9, y, x] += w * a * a
                    out[10, y, x] += wc * a
                    out[11, y, x] += ws * a
                    out[12, y, x] += wc * c
                    out[13, y, x] += wc * s
                    out[14, y, x] += ws * s
                    out[15, y, x] += wi
                    out[16, y, x] += wi * b
                    out[17, y, x] += wi * a
                    out[18, y, x] += wi * c
                    out[19, y, x] += wi * s
                    out[20, y, x] += wi * value
                    out[21, y, x] += w * known
    return out
