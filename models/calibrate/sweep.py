"""A bench's measurement: frames of a white screen through a small hole that moves across the lens's pupil.

A hole at the tangents nu lights the pixel at X with one ray alone, of the tangents nu + chief ray (X): one sweep shows
the angular response of every type, the aperture, and how the chief ray turns over the array.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError, TileParameters

Floats = npt.NDArray[np.float64]
BLOCK = 12  # px along a side of what is averaged: the chief ray hardly turns within


@dataclass(frozen=True, eq=False)
class Sweep:
    """Means of blocks of pixels, by pixel type.

    holes: (n, 2), tangents (y, x) of the hole's places against the lens's axis.
    diodes: (n, blocks, types, 2), mean signal in any unit, offset taken off; NaN where a block has no pixel of a type.
    places: (blocks, types, 2), mean place (y, x) of these pixels in px from the array's middle.
    gains: (types,), capacitor ratio of each type from frames through the whole pupil.
    """

    holes: Floats
    diodes: Floats
    places: Floats
    gains: Floats

    def __post_init__(self) -> None:
        n, blocks, types = len(self.holes), *self.places.shape[:2]
        if self.diodes.shape != (n, blocks, types, 2) or self.holes.shape != (n, 2) or self.gains.shape != (types,):
            raise ParameterError(f"diodes = array of shape {self.diodes.shape}: must be {(n, blocks, types, 2)}")
        if n < 5:
            raise ParameterError(f"holes = {n}: must be at least 5")


def sunflower(count: int, radius: float) -> Floats:
    """Return places in a disc, of even density, no two alike along any direction.

    A grating's response is so sampled finer than by as many places on a grid.

    count: places. radius: of the disc. Returns (count, 2), places (y, x). Source: [Vogel1979].
    """
    k = np.arange(count) + 0.5
    radii, turn = radius * np.sqrt(k / count), k * np.pi * (3 - np.sqrt(5))
    return radii[:, None] * np.stack([np.sin(turn), np.cos(turn)], 1)


def block_means(samples: Floats, tile: TileParameters) -> Floats:
    """Mean of every type in every block of an array.

    samples: (rows, cols, ...), values of every pixel. tile: pixel types. Returns (blocks, types, ...), NaN where a
    block has no pixel of a type.
    """
    rows, cols = samples.shape[:2]
    down, across = (np.minimum(np.arange(n) // BLOCK, max(n // BLOCK - 1, 0)) for n in (rows, cols))
    blocks = (down[-1] + 1) * (across[-1] + 1)
    number = (down[:, None] * (across[-1] + 1) + across) * tile.n_types + tile.type_map(rows, cols)
    size = blocks * tile.n_types
    count = np.bincount(number.ravel(), minlength=size)
    flat = samples.reshape(rows * cols, -1)
    sums = np.stack([np.bincount(number.ravel(), values, size) for values in flat.T], -1)
    means = np.where(count[:, None] > 0, sums / np.maximum(count, 1)[:, None], np.nan)
    return means.reshape(blocks, tile.n_types, *samples.shape[2:])
