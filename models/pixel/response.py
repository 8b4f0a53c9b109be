"""The angular response of one photodiode [Jayasuriya2017, Eq. 2.2, 3.1 and 3.3]."""

import numpy as np


def aperture(theta_x, theta_y, sigma):
    """Common-mode response A(theta): Gaussian of standard deviation ``sigma`` (rad), 1 on the axis.

    theta_x, theta_y: rad, |theta| <= pi/2, arrays of one floating type, which the result keeps.
    Far out it stops at the smallest normal number of that type instead of becoming denormal.
    """
    theta_x, theta_y = _floats(theta_x, theta_y)
    exponent = -0.5 * ((theta_x / sigma) ** 2 + (theta_y / sigma) ** 2)
    return np.exp(np.maximum(exponent, np.log(np.finfo(exponent.dtype).tiny) + 1))


def response(alpha, beta, gamma, theta_x, theta_y, m, sigma):
    """rho(alpha, beta, gamma; theta) = A (1 + m cos(beta (theta_x cos gamma + theta_y sin gamma) + alpha)).

    alpha, gamma: rad. beta: 0..50 rad of response per rad of angle. m: 0..1. sigma: rad.
    theta_x, theta_y: rad, |theta| <= pi/2 (grazing light included: nothing here takes a tangent).
    Returns 0..2, of the type of theta. The second diode of a pixel has alpha + pi.
    """
    theta_x, theta_y = _floats(theta_x, theta_y)
    phase = beta * (theta_x * np.cos(gamma) + theta_y * np.sin(gamma)) + alpha
    # The cosine may round past -1 at m = 1; a photocurrent is never negative.
    modulation = np.maximum(1 + m * np.cos(phase), 0)
    return (aperture(theta_x, theta_y, sigma) * modulation).astype(theta_x.dtype)


def vignetting(nu_x, nu_y, power):
    """omega(nu) = cos(theta)**power of a ray with tangents nu_x, nu_y: 0..1, 1 on the axis."""
    nu_x, nu_y = _floats(nu_x, nu_y)
    # hypot keeps huge tangents (grazing light) from overflowing as their squares would.
    return (1 / np.hypot(1, np.hypot(nu_x, nu_y)) ** power).astype(nu_x.dtype)


def _floats(x, y):
    x, y = np.asarray(x), np.asarray(y)
    dtype = np.result_type(x, y)
    dtype = dtype if dtype.kind == "f" else np.float64
    return x.astype(dtype), y.astype(dtype)
