"""The fast and coarse way: scalar waves through thin opaque lines in one medium, by their angular spectrum.

It knows no polarization, no resonance and no reflection, and takes a fiftieth of the rigorous solution's time at 21
orders; at periods near the wavelength its curves are off by more than half (the page of `make pixel` has the figures).
What it adds is a pixel of finite width: the light that leaves a pixel below its gratings.
"""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from talbot.pixels.optics.geometry import QUADRATURE, PixelGeometry
from talbot.pixels.optics.scattering import normal_wave
from talbot.pixels.optics.solve import Floats
from talbot.platforms.materials import refractive_index

ORDERS = 41
SAMPLES = 8192
WINDOW = 8  # of the field, in pixels


def scalar_shares(
    geometry: PixelGeometry, angles: npt.ArrayLike, wavelength_um: float, shifts: Sequence[float] = QUADRATURE
) -> Floats:
    """Shares (shifts, A) of the light that passes an endless amplitude pixel, of each diode's half.

    angles: (A,) in rad in air, in the plane across the lines.
    """
    wave, index = 2 * np.pi / wavelength_um, float(refractive_index("silica", wavelength_um).real)
    n = np.arange(ORDERS) - ORDERS // 2
    kx = wave * np.sin(np.atleast_1d(angles))[:, None] + 2 * np.pi * n / geometry.period_um
    kz = normal_wave((wave * index) ** 2 - kx**2)
    field = _line(n, geometry.fill) * np.exp(1j * kz * between(geometry))
    steps = np.subtract.outer(n, n)
    out = []
    for shift in np.add(geometry.shift, shifts):
        mask = _line(steps, geometry.analyzer_fill) * np.exp(-2j * np.pi * steps * shift)
        out.append(np.sum(np.abs(field @ mask.T) ** 2 * kz.real, -1) / kz.real[:, ORDERS // 2] / 2)
    return np.array(out)


def crosstalk(geometry: PixelGeometry, angles: npt.ArrayLike, wavelength_um: float, samples: int = SAMPLES) -> Floats:
    """Share (A,) of the light through one pixel's gratings that reaches the silicon outside that pixel.

    All pixels have the analyzer of ``geometry``; light falls on one alone, its pitch wide. samples: of the field.
    """
    stack, wave = geometry.stack, 2 * np.pi / wavelength_um
    index = float(refractive_index("silica", wavelength_um).real)
    width = WINDOW * geometry.pitch_um
    x = (np.arange(samples) + 0.5) / samples * width - width / 2
    inside = np.abs(x) <= geometry.pitch_um / 2
    rest = stack.metal("analyzer", geometry.analyzer).bottom_um - stack.surface_um if geometry.analyzer else 0.0
    k = 2 * np.pi * np.fft.fftfreq(samples, width / samples)
    out = []
    for angle in np.atleast_1d(angles):
        tilt = wave * np.sin(angle)
        kz = normal_wave((wave * index) ** 2 - (k + tilt) ** 2)
        field = np.where(inside, _spaces(x, geometry.period_um, geometry.fill, 0.0), 0) + 0j
        field = np.fft.ifft(np.fft.fft(field) * np.exp(1j * kz * between(geometry)))
        if geometry.analyzer:
            field = field * _spaces(x, geometry.period_um, geometry.analyzer_fill, geometry.shift)
        power = np.abs(np.fft.ifft(np.fft.fft(field) * np.exp(1j * kz * rest))) ** 2
        out.append(power[~inside].sum() / power.sum())
    return np.array(out)


def between(geometry: PixelGeometry) -> float:
    """Distance of the gratings' middles, or of the upper one's from the silicon."""
    upper = geometry.stack.metal("diffraction", geometry.diffraction).thickness_um
    lower = geometry.stack.metal("analyzer", geometry.analyzer).thickness_um if geometry.analyzer else 0.0
    return geometry.gap_um + (upper + lower) / 2


def _line(orders: npt.NDArray[np.integer], fill: float) -> Floats:
    """Fourier coefficients of spaces between opaque lines, one line in the middle."""
    return (orders == 0) - fill * np.sinc(orders * fill)


def _spaces(x: Floats, period: float, fill: float, shift: float) -> npt.NDArray[np.bool_]:
    return np.abs((x / period - shift + 0.5) % 1 - 0.5) >= fill / 2
