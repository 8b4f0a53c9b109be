"""Scattering matrices of a stack that repeats along x: overflow-free for any thickness and loss.

Lengths are in units of wavelength / (2 pi), so that the wave number of vacuum is 1; fields vary as exp(i k x - i w t).
Amplitudes are those of the electric field's components along the layers, of every order n with
kx_n = kx_0 + n wavelength / period. Where ky = 0 the components separate: "te" has Ey alone, "tm" Ex alone; else "both"
has Ex of all orders, then Ey.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce

import numpy as np
import numpy.typing as npt

Complexes = npt.NDArray[np.complexfloating]
TINY = 1e-12  # |q^2| below which an order counts as grazing (Rayleigh's anomaly) and is damped, lest H be infinite


@dataclass(frozen=True)
class Orders:
    """The plane waves of a problem: kx (..., N) and ky (..., 1).

    polarization: "te", "tm" or "both". N is odd, and order 0 in the middle.
    """

    kx: npt.NDArray[np.floating]
    ky: npt.NDArray[np.floating]
    polarization: str

    @property
    def components(self) -> int:
        """Components of the electric field, 1 or 2."""
        return 2 if self.polarization == "both" else 1


@dataclass(frozen=True)
class Scattering:
    """The scattering of a part of a stack: matrices (..., B, B) over amplitudes in the half spaces above and below.

    above, below: reflection of waves from above and from below.
    down, up: transmission.
    """

    above: Complexes
    down: Complexes
    below: Complexes
    up: Complexes

    def over(self, lower: "Scattering") -> "Scattering":
        """This part on top of ``lower`` (Redheffer's star product)."""
        identity = np.eye(self.above.shape[-1])
        falling = np.linalg.solve(identity - self.below @ lower.above, self.down)
        rising = np.linalg.solve(identity - lower.above @ self.below, lower.up)
        return Scattering(
            above=self.above + self.up @ (lower.above @ falling),
            down=lower.down @ falling,
            below=lower.below + lower.down @ (self.below @ rising),
            up=self.up @ rising,
        )

    def spread(self) -> "Scattering":
        """Matrices over all orders (..., cN, cN) from those of each order by itself (..., N, c, c)."""
        return Scattering(*(spread(part) for part in (self.above, self.down, self.below, self.up)))


def spread(each: Complexes) -> Complexes:
    """Return a matrix over all orders (..., cN, cN) from a matrix of each order (..., N, c, c)."""
    *batch, n, c, _ = each.shape
    out = np.zeros((*batch, c, n, c, n), complex)
    at = np.arange(n)
    for i in range(c):
        for j in range(c):
            out[..., i, at, j, at] = each[..., i, j]
    return out.reshape(*batch, c * n, c * n)


def normal_wave(square: npt.NDArray[np.inexact]) -> Complexes:
    """Wave number q along z of a wave that falls or decays downwards, from its square."""
    q: Complexes = np.sqrt(np.where(np.abs(square) < TINY, TINY * 1j, square + 0j)).astype(np.complex128)
    return np.where(q.imag + q.real < 0, -q, q)


def admittance(permittivity: complex, orders: Orders) -> tuple[Complexes, Complexes]:
    """Wave number q (..., N), and H from E of each order (..., N, c, c), falling, in a uniform medium."""
    kx, ky = orders.kx, orders.ky
    q = normal_wave(permittivity - kx**2 - ky**2 + 0j)
    if orders.polarization == "te":
        return q, -q[..., None, None]
    if orders.polarization == "tm":
        return q, (permittivity / q)[..., None, None]
    rows = [[-kx * ky, kx**2 - permittivity], [permittivity - ky**2, kx * ky]]
    return q, np.moveaxis(np.array([[np.broadcast_to(e, q.shape) / q for e in row] for row in rows]), (0, 1), (-2, -1))


def films(media: Sequence[tuple[complex, float]], orders: Orders) -> Scattering:
    """Uniform films from the top: (permittivity, thickness). The first and the last are half spaces.

    A thickness of the first and the last counts: how far from the next face its amplitudes are taken. Of one medium it
    is the way through it. Matrices of each order by itself: see `Scattering.spread`.
    """
    parts: list[Scattering] = []
    identity = np.eye(orders.components, dtype=complex)
    before: Complexes | None = None
    for permittivity, thickness in media:
        q, y = admittance(permittivity, orders)
        if before is not None:
            r = np.linalg.solve(before + y, before - y)
            parts.append(Scattering(r, identity + r, -r, identity - r))
        passed = np.exp(1j * q * thickness).astype(np.complex128)[..., None, None] * identity
        nothing = np.zeros(passed.shape, complex)
        parts.append(Scattering(nothing, passed, nothing, passed))
        before = y
    return reduce(Scattering.over, parts)
