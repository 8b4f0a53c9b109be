"""The angular response of one photodiode [Jayasuriya2017, Eq. 2.2, 3.1 and 3.3]."""

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.floating]


def aperture(theta_x: npt.ArrayLike, theta_y: npt.ArrayLike, sigma: float) -> Floats:
    """Common-mode angular response A(theta), a Gaussian.

    theta_x, theta_y: incidence angle in rad, |theta| <= pi/2. sigma: standard deviation in rad. Returns 1 on the axis,
    of the floating type of theta; not below the smallest normal number of that type. Source: [Jayasuriya2017], Eq. 2.2.
    """
    theta_x, theta_y = _floats(theta_x, theta_y)
    exponent = -0.5 * ((theta_x / sigma) ** 2 + (theta_y / sigma) ** 2)
    return np.exp(np.maximum(exponent, np.log(np.finfo(exponent.dtype).tiny) + 1))


def response(
    alpha: float, beta: float, gamma: float, theta_x: npt.ArrayLike, theta_y: npt.ArrayLike, m: float, sigma: float
) -> Floats:
    """Angular response rho = A (1 + m cos(beta (theta_x cos gamma + theta_y sin gamma) + alpha)).

    The second diode of a pixel has alpha + pi.

    alpha: phase of the analyzer grating, rad. beta: angular frequency, 0..50 rad of response per rad of angle. gamma:
    grating orientation, rad. theta_x, theta_y: incidence angle in rad, |theta| <= pi/2, grazing light included. m:
    modulation depth, 0..1. sigma: standard deviation of the aperture in rad. Returns 0..2, of the floating type of
    theta. Source: [Jayasuriya2017], Eq. 3.1.
    """
    theta_x, theta_y = _floats(theta_x, theta_y)
    phase = beta * (theta_x * np.cos(gamma) + theta_y * np.sin(gamma)) + alpha
    # The cosine may round past -1 at m = 1; a photocurrent is never negative.
    modulation = np.maximum(1 + m * np.cos(phase), 0)
    return (aperture(theta_x, theta_y, sigma) * modulation).astype(theta_x.dtype)


def vignetting(nu_x: npt.ArrayLike, nu_y: npt.ArrayLike, power: float) -> Floats:
    """Vignetting omega(nu) = cos(theta)**power of a ray.

    nu_x, nu_y: tangents of the incidence angle. power: exponent, 0 or more. Returns 0..1, 1 on the axis, of the
    floating type of nu. Source: [Jayasuriya2017], Eq. 3.3.
    """
    nu_x, nu_y = _floats(nu_x, nu_y)
    # hypot does not overflow for huge tangents (grazing light), as their squares would.
    return (1 / np.hypot(1, np.hypot(nu_x, nu_y)) ** power).astype(nu_x.dtype)


def _floats(x: npt.ArrayLike, y: npt.ArrayLike) -> tuple[Floats, Floats]:
    x, y = np.asarray(x), np.asarray(y)
    dtype = np.result_type(x, y)
    dtype = dtype if dtype.kind == "f" else np.float64
    return x.astype(dtype), y.astype(dtype)
