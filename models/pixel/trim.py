"""The flat-field residual of each pixel type and the capacitor ratio that nulls it.

The amplifier forms a - g b of a pixel's diodes. A uniform area leaves k = (a - b) / (a + b) in the difference,
because the lens cuts the response off at a fraction of its period; g = (1 + k) / (1 - k) = a / b nulls it.
"""

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import OpticsParameters, ParameterError, TileParameters
from talbot.models.pixel.weights import view_weights

GAIN_MAX = 64.0  # limit for a diode that receives nothing of a flat field (m = 1, beta = 0)


def residual(weights: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Flat-field residual of each pixel type.

    weights: (types, 2, views, views), view weights. Returns (types,), k, -1..1.
    """
    a, b = weights.sum((2, 3)).T
    return (a - b) / (a + b)


def gains(k: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Capacitor ratio g = (1 + k) / (1 - k) that nulls a residual.

    k: residual, -1..1. Returns g, limited to 1/64..64.
    """
    edge = (GAIN_MAX - 1) / (GAIN_MAX + 1)
    limited = np.clip(k, -edge, edge)
    return (1 + limited) / (1 - limited)


def optical_gains(tile: TileParameters, optics: OpticsParameters) -> npt.NDArray[np.float64]:
    """Capacitor ratio of each pixel type, computed from the optics.

    tile: pixel types. optics: lens and gratings. Returns (types,), g.
    """
    return gains(residual(view_weights(tile, optics)))


def measured_gains(samples: npt.NDArray[np.floating], tile: TileParameters) -> npt.NDArray[np.float64]:
    """Capacitor ratio of each pixel type, measured from a flat-field frame.

    samples: (rows, cols, 2), diode pairs in any unit; pixels of 0 do not count. tile: pixel types. Returns (types,), g;
    1 for a type that an array smaller than a tile has no pixel of. Raises ParameterError if a type receives no light.
    """
    rows, cols = samples.shape[:2]
    kinds = tile.type_map(rows, cols)
    sums = np.stack([np.bincount(kinds.ravel(), samples[..., d].ravel(), tile.n_types) for d in (0, 1)])
    sums[:, np.bincount(kinds.ravel(), minlength=tile.n_types) == 0] = 1
    dark = np.flatnonzero(~(sums.sum(0) > 0)).tolist()
    if dark:
        raise ParameterError(f"flat-field frame of types {dark} = 0: must have light in every pixel type")
    return gains((sums[0] - sums[1]) / (sums[0] + sums[1]))
