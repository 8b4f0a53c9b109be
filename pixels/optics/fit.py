"""The formula on which the sensor rests, Eq. 3.1 [Jayasuriya2017], fitted to a response, and how wrong it is."""

from dataclasses import asdict, dataclass

import numpy as np

from talbot.pixels.optics.geometry import QUADRATURE
from talbot.pixels.optics.response import Response
from talbot.pixels.optics.solve import Floats

BETA_MAX = 40.0
BETAS = np.arange(2.0, BETA_MAX, 0.5)
SIGMAS = 0.3, 5.0
SIGMA_MAX = 10.0  # as of models.parameters.OpticsParameters


@dataclass(frozen=True)
class Fit:
    """Eq. 3.1 for a pixel: each diode has the share  q/2 A(theta) (1 + m cos(beta theta + alpha + turn 2 pi shift)).

    Attributes
    ----------
    alpha : float
        Rad, of the diode whose analyzer is at the geometry's shift.
    beta : float
        Rad per rad.
    sigma : float
        Rad, of the aperture A, a Gaussian.
    m : float
        0..1.
    turn : int
        1 or -1: the sign of the phase of an analyzer's shift.
    quantum_efficiency : float
        Share of the light on the pixel that both diodes receive, over all angles.
    diattenuation : float
        (along - across) / (along + across) of the quantum efficiency.
    extinction_ratio : float
        The larger of the two polarizations over the smaller.
    residual_rms : float
        Of all four curves from the formula, relative to the mean response.
    unexplained : float
        Share of the differences' variance that the formula leaves.
    """

    alpha: float
    beta: float
    sigma: float
    m: float
    turn: int
    quantum_efficiency: float
    diattenuation: float
    extinction_ratio: float
    residual_rms: float
    unexplained: float

    def curve(self, angles: Floats) -> Floats:
        """Return the formula, of mean 1 without aperture: (4, A)."""
        aperture = np.exp(-0.5 * (angles / self.sigma) ** 2)
        phase = self.beta * angles + self.alpha + self.turn * 2 * np.pi * np.array(QUADRATURE)[:, None]
        return aperture * (1 + self.m * np.cos(phase))

    @property
    def figure(self) -> float:
        """Signal to shot noise of a difference: m sqrt(quantum efficiency), times the explained share."""
        return float(self.m * np.sqrt(self.quantum_efficiency) * max(0.0, 1 - self.unexplained))

    def as_dict(self) -> dict[str, float]:
        """All figures."""
        return asdict(self)


def fit(response: Response) -> Fit:
    """Fit Eq. 3.1 to a response in the plane across the lines, the mean of its wavelengths, without polarization."""
    angles, curves = response.angles, response.unpolarized.mean(0)
    best = min((_start(angles, curves, turn) for turn in (1, -1)), key=lambda start: start[0])
    _, turn, beta, sigma = best
    from scipy.optimize import least_squares  # imported where it is needed: it is slow

    done = least_squares(
        lambda x: _linear(angles, curves, turn, x[0], x[1])[1].ravel(),
        (beta, sigma),
        bounds=([0.0, 0.02], [BETA_MAX + 10, SIGMA_MAX]),
        x_scale=(1.0, 0.1),
    )
    beta, sigma = map(float, done.x)
    (mean, cosine, sine), residual = _linear(angles, curves, turn, beta, sigma)
    level = curves.mean()
    difference = curves[:2] - curves[2:]
    left = (residual[:2] - residual[2:]).var() / max(float(np.mean(difference**2)), np.finfo(float).tiny)
    along, across = response.shares.mean((0, 2, 3))
    return Fit(
        alpha=float(np.arctan2(-sine, cosine)),
        beta=beta,
        sigma=sigma,
        m=float(min(np.hypot(cosine, sine) / mean, 1.0)),
        turn=turn,
        quantum_efficiency=float(2 * level),
        diattenuation=float((along - across) / (along + across)),
        extinction_ratio=float(max(along, across) / min(along, across)),
        residual_rms=float(np.sqrt(np.mean(residual**2)) / level),
        unexplained=float(min(left, 1.0)),
    )


def _linear(angles: Floats, curves: Floats, turn: int, beta: float, sigma: float) -> tuple[Floats, Floats]:
    """Best mean, cosine and sine of the formula, and the residual (4, A)."""
    aperture = np.exp(-0.5 * (angles / sigma) ** 2)
    phase = beta * angles + turn * 2 * np.pi * np.array(QUADRATURE)[:, None]
    basis = np.stack([np.broadcast_to(aperture, phase.shape), aperture * np.cos(phase), aperture * np.sin(phase)])
    flat = basis.reshape(3, -1)
    coefficients = np.linalg.solve(flat @ flat.T, flat @ curves.ravel())
    return coefficients, curves - np.tensordot(coefficients, basis, 1)


def _start(angles: Floats, curves: Floats, turn: int) -> tuple[float, int, float, float]:
    """Least squares over a grid: error, turn, beta, sigma."""
    tried = ((float(b), s) for b in BETAS for s in SIGMAS)
    return min((float(np.sum(_linear(angles, curves, turn, b, s)[1] ** 2)), turn, b, s) for b, s in tried)
