"""Pictures from their gradients: Poisson's equation in closed form, by cosine transforms."""

import numpy as np
import numpy.typing as npt
from scipy.fft import dctn, idctn

from talbot.models.parameters import check_real

Floats = npt.NDArray[np.float64]


def differences(pictures: npt.ArrayLike) -> tuple[Floats, Floats]:
    """Differences from the left and from the top neighbour.

    pictures: (..., height, width), intensity, any unit. Returns (..., height, width), along x and along y; 0 in the
    first column and the first row.
    """
    p = np.asarray(pictures, np.float64)
    return np.diff(p, axis=-1, prepend=p[..., :1]), np.diff(p, axis=-2, prepend=p[..., :1, :])


def integrate(dx: npt.ArrayLike, dy: npt.ArrayLike, screen: float = 0.0) -> Floats:
    """Pictures whose differences are nearest to some, by least squares.

    dx, dy: (..., height, width), as of `differences`; the first column and row are ignored. screen: weight of the
    squared intensity, 0 or more: what keeps errors from spreading. Returns (..., height, width), of mean 0.
    """
    dx, dy = np.array(dx, np.float64), np.array(dy, np.float64)
    dx[..., 0], dy[..., 0, :] = 0, 0
    source = dx + dy
    source[..., :-1] -= dx[..., 1:]
    source[..., :-1, :] -= dy[..., 1:, :]
    return smooth(source, screen)


def smooth(source: npt.ArrayLike, screen: float) -> Floats:
    """Solve screen u - Laplacian(u) = source less its mean, with edges that nothing crosses.

    source: (..., height, width), right side. screen: 0 or more, in 1/px^2. Returns (..., height, width), u, of mean 0.
    """
    check_real("screen", screen, 0, 1e9)
    wave = np.asarray(dctn(np.asarray(source, np.float64), axes=(-2, -1)))
    y, x = (2 - 2 * np.cos(np.pi * np.arange(n) / n) for n in wave.shape[-2:])
    scale = y[:, None] + x + screen
    scale[0, 0] = np.inf
    return np.asarray(idctn(wave / scale, axes=(-2, -1)))
