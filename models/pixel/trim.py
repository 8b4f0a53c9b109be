"""The flat-field residual of each pixel type and the capacitor ratio that nulls it.

The amplifier converts a - g b of a pixel's diodes. A uniform area leaves k = (a - b) / (a + b) in the difference,
because the lens cuts the response off at a fraction of its period; g = (1 + k) / (1 - k) = a / b nulls it.
"""

import numpy as np

from models.parameters import ParameterError

from .weights import view_weights

GAIN_MAX = 64.0  # a diode that sees nothing of a flat field asks for no more (m = 1, beta = 0)


def residual(weights):
    """k of each type from view weights (types, 2, views, views): (types,), -1..1."""
    a, b = weights.sum((2, 3)).T
    return (a - b) / (a + b)


def gains(k):
    """Capacitor ratio g = (1 + k) / (1 - k) for residuals ``k`` in -1..1, limited to 1/64..64."""
    edge = (GAIN_MAX - 1) / (GAIN_MAX + 1)
    k = np.clip(k, -edge, edge)
    return (1 + k) / (1 - k)


def optical_gains(tile, optics):
    """g of each pixel type, computed from the optics: (types,) float64."""
    return gains(residual(view_weights(tile, optics)))


def measured_gains(samples, tile):
    """g of each pixel type from a flat-field frame: (types,).

    samples: diode pairs (rows, cols, 2), both diodes of a pixel, any unit; pixels of 0 take no part.
    Raises ParameterError where a type saw no light.
    """
    rows, cols = samples.shape[:2]
    kinds = tile.type_map(rows, cols)
    sums = np.stack([np.bincount(kinds.ravel(), samples[..., d].ravel(), tile.n_types) for d in (0, 1)])
    if not (sums.sum(0) > 0).all():
        dark = np.flatnonzero(~(sums.sum(0) > 0)).tolist()
        raise ParameterError(f"flat-field frame of types {dark} = 0: must have light in every pixel type")
    return gains((sums[0] - sums[1]) / (sums[0] + sums[1]))
