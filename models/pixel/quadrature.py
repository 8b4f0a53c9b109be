"""How far the sampled capture is from the integral it stands for [Jayasuriya2017, Eq. 3.3]."""

from dataclasses import dataclass
from time import perf_counter

import numpy as np
from scipy.integrate import cubature

from .weights import density, raw_weights


@dataclass(frozen=True)
class Ripple:
    """Light from one scene point over the lens: (1 + cos(2 pi periods nu / (2 nu_max) + 1)) / 2.

    periods: across the diameter of the lens, 0 = the same from everywhere. degrees: direction in which it varies.
    """

    periods: float = 1.0
    degrees: float = 30.0

    def __call__(self, nu_x, nu_y, nu_max):
        along = nu_x * np.cos(np.deg2rad(self.degrees)) + nu_y * np.sin(np.deg2rad(self.degrees))
        return (1 + np.cos(np.pi * self.periods * along / nu_max + 1)) / 2


@dataclass(frozen=True)
class SamplingError:
    """Error of a diode's photocurrent against the exact one, relative to the mean photocurrent of all diodes.

    worst, rms: over the types' diodes. seconds: to compute the view weights.
    """

    worst: float
    rms: float
    seconds: float


def exact(types, optics, light, tolerance=1e-10):
    """Photocurrents by adaptive cubature in polar coordinates over the lens: (types, 2), unscaled.

    light: function of (nu_x, nu_y, nu_max). tolerance: relative, 1e-13..1e-2.
    """

    def integrand(points):
        r, phi = points.T
        x, y = r * np.cos(phi), r * np.sin(phi)
        return (density(types, optics, x, y) * (light(x, y, optics.nu_max) * r)).transpose(2, 0, 1)

    result = cubature(integrand, [0, 0], [optics.nu_max, 2 * np.pi], rtol=tolerance, atol=1e-14)
    return result.estimate


def sampled(types, optics, light):
    """The same from view weights and the light at the middle of each view: (types, 2), unscaled."""
    middle = (np.arange(optics.views) + 0.5) / optics.views * 2 - 1
    nu_y, nu_x = np.meshgrid(middle * optics.nu_max, middle * optics.nu_max, indexing="ij")
    return np.tensordot(raw_weights(types, optics), light(nu_x, nu_y, optics.nu_max), 2)


def sampling_error(types, optics, light=Ripple(), reference=None):
    """SamplingError of `optics.views` and `optics.subsamples`. reference: `exact` of the same, if at hand."""
    reference = exact(types, optics, light) if reference is None else reference
    start = perf_counter()
    raw_weights.__wrapped__(types, optics)  # past the cache
    seconds = perf_counter() - start
    error = np.abs(sampled(types, optics, light) - reference) / reference.mean()
    return SamplingError(float(error.max()), float(np.sqrt((error**2).mean())), seconds)
