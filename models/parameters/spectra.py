"""Spectra by name, and the integrals over them: luminous efficacy, electrons, modulation.

Every integral over wavelength is a sum over `Spectrum.quadrature`: the trapezoidal rule on a grid of 1 nm from the
spectrum's first wavelength to its last (380 and 780 nm of the named illuminants), values between those of a table
interpolated linearly. A laser is one wavelength with weight 1.
"""

import json
from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path

import numpy as np
import numpy.typing as npt

from talbot.models.parameters.checks import ParameterError, check_real

TABLES = Path(__file__).with_name("spectra.json")
FIRST, LAST = 380e-9, 780e-9  # m, of the illuminants; light beyond them is taken as cut
LASERS = 380.0, 1000.0  # nm
STEP_NM = 1
SECOND_RADIATION = 1.435e-2  # m K, and the temperature: by the definition of illuminant A [CIE15]
TEMPERATURE_A = 2848.0
LUMENS = 683.0  # lm/W at 555 nm
EDGES = 490e-9, 590e-9  # m, between the blue, green and red surface
EDGE_WIDTH = 10e-9  # m, of the logistic edges
LIGHTS = "d65", "a", "led", "e"
SURFACES = "gray", "red", "green", "blue"
Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Spectrum:
    """A function of the wavelength: relative power of light, or the reflectance of a surface.

    Attributes
    ----------
    name : str
        As the command line has it.
    wavelengths : tuple of float
        Ascending, in m; a single one is a laser.
    values : tuple of float
        Power per wavelength in any unit, or reflectance 0..1; linear in between, 0 outside.
    """

    name: str
    wavelengths: tuple[float, ...]
    values: tuple[float, ...]

    def __post_init__(self) -> None:
        if len(self.wavelengths) != len(self.values) or not self.wavelengths:
            count = f"{len(self.wavelengths)} wavelengths and {len(self.values)} values"
            raise ParameterError(f"{self.name} = {count}: must be as many of both, at least 1")
        if any(b <= a for a, b in zip(self.wavelengths, self.wavelengths[1:])):
            raise ParameterError(f"{self.name} = wavelengths: must be ascending")
        for value in self.values:
            check_real(self.name, value, 0, 1e30)
        if not max(self.values) > 0:
            raise ParameterError(f"{self.name} = 0 everywhere: must have light at a wavelength")

    def at(self, wavelength: npt.ArrayLike) -> Floats:
        """Value at ``wavelength`` in m, of the same shape."""
        return np.interp(np.asarray(wavelength, np.float64), self.wavelengths, self.values, 0.0, 0.0)

    def quadrature(self) -> tuple[Floats, Floats]:
        """Wavelengths in m (n,) of the sums that represent integrals over this light, and shares of its power (n,)."""
        if len(self.wavelengths) == 1:
            return np.array(self.wavelengths), np.ones(1)
        first, last = (round(1e9 * end) for end in (self.wavelengths[0], self.wavelengths[-1]))
        nodes = np.arange(first, last + 1, STEP_NM) * 1e-9
        power = self.at(np.clip(nodes, self.wavelengths[0], self.wavelengths[-1]))
        power[[0, -1]] /= 2
        return np.asarray(nodes, np.float64), np.asarray(power / power.sum(), np.float64)

    @property
    def efficacy(self) -> float:
        """Luminous efficacy of radiation, 683 lm/W times the mean of the eye's V(wavelength) over the power."""
        nodes, shares = self.quadrature()
        return float(LUMENS * shares @ eye().at(nodes))


@cache
def _tables() -> dict[str, Spectrum]:
    stored = json.loads(TABLES.read_text(encoding="utf-8"))
    out = {}
    for name in stored["sources"]:
        steps = range(len(stored[name]))
        nodes = tuple(1e-9 * (stored["first_nm"] + stored["step_nm"] * k) for k in steps)
        out[name] = Spectrum(name, nodes, tuple(stored[name]))
    return out


def eye() -> Spectrum:
    """Return the eye's luminous efficiency V(wavelength), of the photopic observer of 1924 [CIE15]."""
    return _tables()["eye"]


@lru_cache(maxsize=64)
def light(name: str) -> Spectrum:
    """Light by name.

    name: d65 (daylight), a (incandescent), led (white phosphor LED of 4103 K, LED-B3), e (equal energy) [CIE15], of 380
    to 780 nm; or laser:NM, one wavelength of 380..1000 nm. Raises ParameterError for another name or laser.
    """
    kind, colon, number = name.partition(":")
    if kind == "laser" and colon:
        try:
            nm = float(number)
        except ValueError:
            nm = np.nan
        if not LASERS[0] <= nm <= LASERS[1]:
            raise ParameterError(f"light = {name!r}: laser must be in {LASERS[0]:g}..{LASERS[1]:g} nm, as laser:650")
        return Spectrum(name, (1e-9 * nm,), (1.0,))
    if name not in LIGHTS:
        raise ParameterError(f"light = {name!r}: must be one of {', '.join(LIGHTS)}, laser:NM")
    if name in _tables():
        return _tables()[name]
    nodes = 1e-9 * np.arange(round(1e9 * FIRST), round(1e9 * LAST) + 1, STEP_NM)
    power = np.ones(nodes.size)
    if name == "a":
        power = nodes**-5 / np.expm1(SECOND_RADIATION / (TEMPERATURE_A * nodes)) / nodes[0] ** -5
    return Spectrum(name, tuple(nodes.tolist()), tuple(power.tolist()))


@lru_cache(maxsize=8)
def surface(name: str) -> Spectrum:
    """Reflectance of a surface by name, 0..1 from 380 to 1000 nm, relative to a gray one of the same radiance.

    Red, green and blue add up to 1 at every wavelength: logistic edges of 10 nm at 490 and 590 nm. Raises
    ParameterError for another name.
    """
    if name not in SURFACES:
        raise ParameterError(f"reflectance = {name!r}: must be one of {', '.join(SURFACES)}")
    nodes = 1e-9 * np.arange(round(LASERS[0]), round(LASERS[1]) + 1, STEP_NM)
    above = [1 / (1 + np.exp(-(nodes - edge) / EDGE_WIDTH)) for edge in EDGES]
    parts = {"gray": np.ones(nodes.size), "blue": 1 - above[0], "green": above[0] - above[1], "red": above[1]}
    return Spectrum(name, tuple(nodes.tolist()), tuple(parts[name].tolist()))
