"""Refractive index and absorption of silicon at 300 K [Green2008], interpolated linearly."""

import numpy as np
import numpy.typing as npt

# nm, n, k
_TABLE = """
350 5.494 2.938     | 360 6.026 2.966     | 370 6.891 2.171     | 380 6.616 0.946     | 390 6.039 0.445
400 5.613 0.296     | 410 5.330 0.227     | 420 5.119 0.176     | 430 4.949 0.138     | 440 4.812 0.107
450 4.691 0.086302  | 460 4.587 0.071381  | 470 4.497 0.062086  | 480 4.419 0.055004  | 490 4.350 0.049131
500 4.294 0.044165  | 510 4.241 0.039367  | 520 4.193 0.036415  | 530 4.151 0.033108  | 540 4.112 0.030295
550 4.077 0.027968  | 560 4.045 0.025758  | 570 4.015 0.024131  | 580 3.988 0.022524  | 590 3.963 0.021081
600 3.940 0.019934  | 625 3.8885 0.016906 | 650 3.844 0.014431  | 675 3.8055 0.012324 | 700 3.772 0.010528
750 3.717 0.0078185 | 800 3.675 0.0054113 | 850 3.641 0.003612  | 900 3.614 0.0021701 | 950 3.591 0.0011793
1000 3.572 0.0005093
"""
_ROWS = np.array([row.split() for row in _TABLE.replace("\n", "|").split("|") if row.strip()], float).T


def silicon_index(wavelength: npt.ArrayLike) -> npt.NDArray[np.complex128]:
    """Complex refractive index n + i k of silicon [Green2008].

    wavelength: in m, 350e-9..1000e-9; beyond them the index is that of the nearest end.
    """
    at, n, k = _ROWS
    nm = 1e9 * np.asarray(wavelength, float)
    return np.interp(nm, at, n) + 1j * np.interp(nm, at, k)


def absorbed(wavelength: npt.ArrayLike, depth: float) -> npt.NDArray[np.float64]:
    """Share of the light in silicon that is absorbed down to a depth: 1 - exp(-4 pi k depth / wavelength).

    wavelength: in m, 350e-9..1000e-9. depth: in m.
    """
    at = np.asarray(wavelength, float)
    return -np.expm1(-4 * np.pi * silicon_index(at).imag * depth / at)
