"""One grating of rectangular lines by rigorous coupled-wave analysis [Moharam1995], with Li's rules [Li1996].

Lines are uniform along y, so that the modes separate into those without Ex and those without Hx, each an eigenproblem
of N orders in which ky is but an offset of the eigenvalues: oblique (conical) incidence takes no larger ones. The
medium between the lines is the one above and below. The slab is its own mirror image in z: its scattering follows from
fields that are even and odd in z, two linear systems, with no matrix of a thickness that could overflow.
"""

import numpy as np
import numpy.typing as npt

from talbot.pixels.optics.geometry import Slab
from talbot.pixels.optics.scattering import Complexes, Orders, Scattering, admittance, normal_wave, spread


def grating(slab: Slab, thickness: float, orders: Orders) -> Scattering:
    """Scattering of a layer's lines; even ones have one centred at x = 0.

    thickness: as all lengths in `scattering`. Matrices (..., cN, cN).
    """
    q, electric, magnetic = _modes(slab, orders)
    _, outside = admittance(slab.medium, orders)
    magnetic = spread(np.linalg.inv(outside)) @ magnetic  # as the electric field that has it outside
    through = np.exp(1j * q * thickness)[..., None, :]
    identity = np.eye(q.shape[-1])
    even = _reflected(electric * (1 + through), magnetic * (1 - through)) - identity
    odd = _reflected(electric * (1 - through), magnetic * (1 + through)) - identity
    reflected, passed = (even + odd) / 2, (even - odd) / 2
    return Scattering(reflected, passed, reflected, passed)


def moved(part: Scattering, shift: float, orders: Orders) -> Scattering:
    """``part`` moved by ``shift`` periods towards +x."""
    count = orders.kx.shape[-1]
    turn = np.tile(np.exp(-2j * np.pi * shift * (np.arange(count) - count // 2)), orders.components)
    turned = turn[:, None] * turn.conj()
    return Scattering(*(matrix * turned for matrix in (part.above, part.down, part.below, part.up)))


def _reflected(electric: Complexes, magnetic: Complexes) -> Complexes:
    """Twice E (E + H)^-1."""
    both = electric + magnetic
    return 2 * np.linalg.solve(both.swapaxes(-1, -2), electric.swapaxes(-1, -2)).swapaxes(-1, -2)


def _toeplitz(slab: Slab, line: complex, medium: complex, count: int) -> npt.NDArray[np.complex128]:
    """Fourier coefficients of a property of lines and medium, as a matrix over orders."""
    m = np.subtract.outer(np.arange(count), np.arange(count))
    if slab.spans is None:
        share = slab.fill * np.sinc(m / slab.lines * slab.fill) * (m % slab.lines == 0)
    else:
        share = np.zeros((count, count), complex)
        for low, high in slab.spans:
            share += (high - low) * np.sinc(m * (high - low)) * np.exp(-1j * np.pi * m * (low + high))
    return medium * (m == 0) + (line - medium) * share


def _modes(slab: Slab, orders: Orders) -> tuple[Complexes, Complexes, Complexes]:
    """Modes of the lines: wave numbers (..., M), and E and H of each (..., cN, M) as it falls."""
    line, medium = slab.line, slab.medium
    assert line is not None
    kx, ky, count = orders.kx, orders.ky, orders.kx.shape[-1]
    direct = _toeplitz(slab, line, medium, count)
    te = tm = None
    if orders.polarization != "tm":
        squares, fields = np.linalg.eig(direct - _diagonal(kx**2))
        te = normal_wave(squares - ky**2), squares, fields
    if orders.polarization != "te":
        inverse = _toeplitz(slab, 1 / line, 1 / medium, count)
        across = kx[..., :, None] * np.linalg.inv(direct) * kx[..., None, :]
        squares, fields = np.linalg.eig(np.linalg.solve(inverse, np.eye(count) - across))
        tm = normal_wave(squares - ky**2), squares, fields, inverse @ fields * squares[..., None, :]
    if tm is None:
        assert te is not None
        q, _, fields = te
        return q, fields, -fields * q[..., None, :]
    if te is None:
        q, _, fields, electric = tm
        return q, electric, fields * q[..., None, :]
    (q1, squares, ey), (q2, _, hy, ex) = te, tm
    of_kx, of_ky = kx[..., :, None], ky[..., None]
    nothing = np.zeros_like(ey)
    electric = np.block([[nothing, ex], [ey, -of_ky * (np.linalg.inv(direct) @ (of_kx * hy))]])
    hx, hy1 = -ey * (squares / q1)[..., None, :], of_ky * of_kx * ey / q1[..., None, :]
    magnetic = np.block([[hx, nothing], [hy1, hy * q2[..., None, :]]])
    return np.concatenate([q1, q2], -1), electric, magnetic


def _diagonal(values: npt.NDArray[np.floating]) -> npt.NDArray[np.floating]:
    return values[..., None] * np.eye(values.shape[-1])
