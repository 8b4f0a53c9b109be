"""Refractive index of what chips are made of, 350 to 1000 nm: n + i k, a wave as exp(i k x - i w t).

Metals by the Lorentz-Drude model and its parameters of [Rakic1998]; silica by [Malitson1965]; silicon nitride by
[Philipp1973], as a Sellmeier term [Baak1982]; silicon by the table of [Green2008], interpolated linearly. Films of a
process are taken as these bulk materials: their own indices are not published.
"""

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError, check_choice

RANGE_UM = 0.35, 1.0
EV_UM = 1.239841984  # energy of a photon in eV times its wavelength in um

# Plasma frequency in eV; strength, damping in eV and resonance in eV of each term, the free electrons first
_METALS = {
    "aluminium": (
        14.98,
        ((0.523, 0.047, 0), (0.227, 0.333, 0.162), (0.050, 0.312, 1.544), (0.166, 1.351, 1.808), (0.030, 3.382, 3.473)),
    ),
    "copper": (
        10.83,
        ((0.575, 0.030, 0), (0.061, 0.378, 0.291), (0.104, 1.056, 2.957), (0.723, 3.213, 5.300), (0.638, 4.305, 11.18)),
    ),
}
# n^2 = 1 + sum of strength / (1 - (resonance in um / wavelength)^2)
_SELLMEIER = {
    "silica": ((0.6961663, 0.0684043), (0.4079426, 0.1162414), (0.8974794, 9.896161)),
    "nitride": ((2.8939, 0.13967),),
}
# nm, n, k
_SILICON = """
350 5.494 2.938     | 360 6.026 2.966     | 370 6.891 2.171     | 380 6.616 0.946     | 390 6.039 0.445
400 5.613 0.296     | 410 5.330 0.227     | 420 5.119 0.176     | 430 4.949 0.138     | 440 4.812 0.107
450 4.691 0.086302  | 460 4.587 0.071381  | 470 4.497 0.062086  | 480 4.419 0.055004  | 490 4.350 0.049131
500 4.294 0.044165  | 510 4.241 0.039367  | 520 4.193 0.036415  | 530 4.151 0.033108  | 540 4.112 0.030295
550 4.077 0.027968  | 560 4.045 0.025758  | 570 4.015 0.024131  | 580 3.988 0.022524  | 590 3.963 0.021081
600 3.940 0.019934  | 625 3.8885 0.016906 | 650 3.844 0.014431  | 675 3.8055 0.012324 | 700 3.772 0.010528
750 3.717 0.0078185 | 800 3.675 0.0054113 | 850 3.641 0.003612  | 900 3.614 0.0021701 | 950 3.591 0.0011793
1000 3.572 0.0005093
"""
_SILICON_ROWS = np.array([row.split() for row in _SILICON.replace("\n", "|").split("|") if row.strip()], float).T

MATERIALS = "air", *_METALS, *_SELLMEIER, "silicon"


def refractive_index(material: str, wavelength_um: npt.ArrayLike) -> npt.NDArray[np.complex128]:
    """Complex refractive index of ``material`` at vacuum wavelengths (...) in um, 0.35..1.

    Raises ParameterError for another material or wavelength.
    """
    check_choice("material", material, MATERIALS)
    wavelength = np.asarray(wavelength_um, float)
    low, high = RANGE_UM
    outside = wavelength[~((wavelength >= low) & (wavelength <= high))]
    if outside.size:
        raise ParameterError(f"wavelength_um = {outside[0]:g}: must be in [{low:g}, {high:g}], where indices are known")
    if material == "air":
        return np.ones(wavelength.shape, complex)
    if material == "silicon":
        at, n, k = _SILICON_ROWS
        return np.interp(1e3 * wavelength, at, n) + 1j * np.interp(1e3 * wavelength, at, k)
    if material in _SELLMEIER:
        return np.sqrt(1 + sum(s / (1 - (r / wavelength) ** 2) for s, r in _SELLMEIER[material]) + 0j)
    plasma, terms = _METALS[material]
    energy = EV_UM / wavelength
    square = sum(f * plasma**2 / (at**2 - energy**2 - 1j * energy * damping) for f, damping, at in terms)
    return np.sqrt(1 + square)
