"""What the drawn pixel's edges do to its response: scalar waves through its cross-section, beside endless gratings.

A row of pixels of one type, cut across upright lines: gratings in their windows, bars between them, wells in the
silicon. Scalar waves have a beta and m of their own (`optics.scalar`): what counts is the finite pixel over the endless
one, both by them.
"""

from dataclasses import dataclass

import numpy as np

from talbot.models.parameters import ParameterError
from talbot.pixels.optics.geometry import QUADRATURE
from talbot.pixels.optics.scalar import between, scalar_shares
from talbot.pixels.optics.scattering import normal_wave
from talbot.pixels.optics.solve import Floats
from talbot.platforms.materials import refractive_index

from .pixel import BAR, BESIDE, STRIP, UPPER, PixelLayout, grating_polygons

SAMPLES = 8192
ANGLES = np.deg2rad(np.arange(-20, 20.1, 0.5))
BETAS = np.arange(4.0, 40.0, 0.1)


@dataclass(frozen=True)
class Finite:
    """The drawn pixel over endless gratings: ratio of m, ratio of the light that reaches the silicon of both wells.

    light: of what falls on the pixel, its strip of transistors counted as dark.
    """

    m: float
    light: float


def finite(made: PixelLayout, wavelength_um: float) -> Finite:
    """Compare the drawn pixel with endless gratings. Raises ParameterError for lines that are not upright."""
    g = made.geometry
    drawn = drawn_shares(made, ANGLES, wavelength_um)
    endless = scalar_shares(made.drawn, ANGLES, wavelength_um, [QUADRATURE[diode] for diode in made.diodes])
    tall = (g.pitch_um - STRIP) / g.pitch_um
    return Finite(depth(drawn) / depth(endless), tall * float(drawn.sum() / endless.sum()))


def drawn_shares(made: PixelLayout, angles: Floats, wavelength_um: float) -> Floats:
    """Shares (2, A) of the light on the rows of the gratings that reach each well. angles: rad in air, across them."""
    if abs(np.sin(made.kind.gamma)) > 1e-9:
        raise ParameterError(f"gamma_deg = {made.kind.gamma_deg:g}: must be 0, lines that are upright in the section")
    g, grid = made.geometry, made.process.grid_um
    wave, index = 2 * np.pi / wavelength_um, float(refractive_index("silica", wavelength_um).real)
    pitch, half = g.pitch_um, g.pitch_um / 2
    x = (np.arange(SAMPLES) + 0.5) / SAMPLES * pitch
    bars = (np.abs((x + half / 2) % half - half / 2) <= BAR) | (np.abs(x - half) <= BAR)
    upper, lower = ~bars, np.ones(SAMPLES, bool)
    for level, corners in grating_polygons(made):
        across = [grid * corner[0] for corner in corners]
        inside = (x >= min(across)) & (x <= max(across))
        (upper if level == UPPER else lower)[inside] = False
    rest = g.stack.metal("analyzer", str(g.analyzer)).bottom_um - g.stack.surface_um
    k = 2 * np.pi * np.fft.fftfreq(SAMPLES, pitch / SAMPLES)
    wells = [np.abs(x - half * (side + 0.5)) <= half / 2 - BESIDE for side in (0, 1)]
    out = np.zeros((2, len(angles)))
    for n, angle in enumerate(angles):
        kz = normal_wave((wave * index) ** 2 - (k + wave * np.sin(angle)) ** 2)
        field = upper + 0j
        for mask, depth_um in ((lower, between(g)), (None, rest)):
            field = np.fft.ifft(np.fft.fft(field) * np.exp(1j * kz * depth_um))
            field = field if mask is None else field * mask
        power = np.abs(field) ** 2
        out[:, n] = [power[well].sum() / SAMPLES for well in wells]
    return out


def depth(shares: Floats) -> float:
    """Modulation of difference over sum by the wave that explains most of it, at `ANGLES`."""
    q = (shares[0] - shares[1]) / (shares[0] + shares[1])
    best = 0.0
    for beta in BETAS:
        basis = np.stack([np.cos(beta * ANGLES), np.sin(beta * ANGLES)], 1)
        found, *_ = np.linalg.lstsq(basis, q, rcond=None)
        best = max(best, float(np.hypot(*found)))
    return best
