"""Refractive index of what chips are made of, 350 to 1000 nm: n + i k, a wave as exp(i k x - i w t).

Metals by the Lorentz-Drude model and its parameters of [Rakic1998]; silica by [Malitson1965]; silicon nitride by
[Philipp1973], as a Sellmeier term [Baak1982]; silicon by [Green2008] (`models/parameters/silicon.py`). Films of a
process are taken as these bulk materials: their own indices are not published.
"""

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError, check_choice
from talbot.models.parameters.silicon import silicon_index

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
        return silicon_index(1e-6 * wavelength)
    if material in _SELLMEIER:
        return np.sqrt(1 + sum(s / (1 - (r / wavelength) ** 2) for s, r in _SELLMEIER[material]) + 0j)
    plasma, terms = _METALS[material]
    energy = EV_UM / wavelength
    square = sum(f * plasma**2 / (at**2 - energy**2 - 1j * energy * damping) for f, damping, at in terms)
    return np.sqrt(1 + square)
