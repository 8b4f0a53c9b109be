"""Error of the sampled capture against the integral that it approximates [Jayasuriya2017, Eq. 3.3]."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from time import perf_counter

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import OpticsParameters, PixelType
from talbot.models.pixel.weights import density, raw_weights

Floats = npt.NDArray[np.float64]
Light = Callable[[Floats, Floats, float], Floats]


@dataclass(frozen=True)
class Ripple:
    """Light from one scene point over the lens: (1 + cos(2 pi periods nu / (2 nu_max) + 1)) / 2.

    periods: periods across the diameter of the lens; 0 is the same light from every direction.
    degrees: direction in which the light varies.
    """

    periods: float = 1.0
    degrees: float = 30.0

    def __call__(self, nu_x: Floats, nu_y: Floats, nu_max: float) -> Floats:
        """Radiance at points of the pupil."""
        along = nu_x * np.cos(np.deg2rad(self.degrees)) + nu_y * np.sin(np.deg2rad(self.degrees))
        return (1 + np.cos(np.pi * self.periods * along / nu_max + 1)) / 2


@dataclass(frozen=True)
class SamplingError:
    """Error of a diode's photocurrent against the exact one, relative to the mean photocurrent of all diodes.

    worst, rms: over the diodes of all types.
    seconds: time to compute the view weights.
    """

    worst: float
    rms: float
    seconds: float


def exact(
    types: Sequence[PixelType], optics: OpticsParameters, light: Light, tolerance: float = 1e-10
) -> npt.NDArray[np.float64]:
    """Photocurrents by adaptive cubature in polar coordinates over the lens.

    types: pixel types. optics: lens and gratings. light: radiance as a function of (nu_x, nu_y, nu_max). tolerance:
    relative, 1e-13..1e-2. Returns (types, 2), not scaled. Source: [Jayasuriya2017], Eq. 3.3.
    """

    def _integrand(points: Floats) -> Floats:
        r, phi = points.T
        x, y = r * np.cos(phi), r * np.sin(phi)
        return (density(types, optics, x, y) * (light(x, y, optics.nu_max) * r)).transpose(2, 0, 1)

    from scipy.integrate import cubature  # imported where it is needed: it is slow

    # SciPy's stub takes the default of atol, 0, for its type.
    result = cubature(_integrand, [0, 0], [optics.nu_max, 2 * np.pi], rtol=tolerance, atol=1e-14)  # pyright: ignore[reportArgumentType]
    return result.estimate


def sampled(types: tuple[PixelType, ...], optics: OpticsParameters, light: Light) -> npt.NDArray[np.float64]:
    """Photocurrents from the view weights and the light at the middle of each view.

    types: pixel types. optics: lens, gratings and views. light: as in `exact`. Returns (types, 2), not scaled.
    """
    middle = (np.arange(optics.views) + 0.5) / optics.views * 2 - 1
    nu_y, nu_x = np.meshgrid(middle * optics.nu_max, middle * optics.nu_max, indexing="ij")
    return np.tensordot(raw_weights(types, optics), light(nu_x, nu_y, optics.nu_max), 2)


def sampling_error(
    types: tuple[PixelType, ...], optics: OpticsParameters, light: Light = Ripple(), reference: Floats | None = None
) -> SamplingError:
    """Error of a number of views and subsamples.

    types: pixel types. optics: lens, gratings, views and subsamples. light: as in `exact`. reference: (types, 2),
    result of `exact` if it is known. Returns relative error, and time.
    """
    reference = exact(types, optics, light) if reference is None else reference
    start = perf_counter()
    raw_weights.__wrapped__(types, optics)  # past the cache
    seconds = perf_counter() - start
    error = np.abs(sampled(types, optics, light) - reference) / reference.mean()
    return SamplingError(float(error.max()), float(np.sqrt((error**2).mean())), seconds)
