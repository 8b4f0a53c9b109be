"""Cameras that a user may choose instead of angle-sensitive pixels, behind the same lens, as maps of the light field.

A pixel with nothing before it, an open pixel, sees the whole pupil with the vignetting of the lens alone; its sample of
a white scene is 1. The samples of white of every camera are 1 in the mean: `LIGHT` is what they are of an open pixel.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from talbot.models.capture.projection import Projection
from talbot.models.parameters import OpticsParameters, ParameterError, PixelType, SensorParameters
from talbot.models.parameters.energy import LightParameters
from talbot.models.pixel.weights import raw_weights, view_weights

Floats = npt.NDArray[np.float64]
SEED = 1  # of mask and random projections
MASK = 8  # px of the mask's period, an even number
SHIFT = 1.0  # px by which a view step moves a pixel's place on the mask
PERIOD = 6  # px of the plain camera's blocks, which are all alike
RANDOM = 48  # random responses, as many as a tile of angle-sensitive pixels has
DIODES = 2  # samples of an angle-sensitive pixel
# Light of a sample, of an open pixel's: lenslets and the plain camera lose none, a mask and random weights half
LIGHT: Mapping[str, float] = {
    "asp": LightParameters().gratings,
    "lenslets": 1.0,
    "mask": 0.5,
    "random": 0.5,
    "plain": 1.0,
}


def _open(theta_x: npt.NDArray[np.floating], theta_y: npt.NDArray[np.floating]) -> Floats:
    return np.ones((2, *theta_x.shape))


OPEN = PixelType(0.0, 0.0, 0.0, response=_open)


@lru_cache(maxsize=16)
def open_weights(optics: OpticsParameters, pupil: int) -> Floats:
    """Weights of an open pixel over the pupil.

    optics: lens and vignetting. pupil: cells along the pupil's diameter. Returns (pupil, pupil), of sum 1.
    """
    raw = raw_weights((OPEN,), replace(optics, views=pupil))[0, 0]
    return raw / raw.sum()


def plain(sensor: SensorParameters, pupil: int) -> Projection:
    """Open pixels.

    sensor: array and lens. pupil: cells along the pupil's diameter. Returns Projection: of one channel and one
    response.
    """
    order = np.zeros((1, PERIOD, PERIOD), np.int64)
    return Projection(sensor.shape, open_weights(sensor.optics, pupil)[None], order, np.ones(1, bool))


def lenslets(sensor: SensorParameters, pupil: int) -> Projection:
    """Open pixels behind lenslets, each of views x views pixels, of which pixel (v, u) sees view (v, u) alone.

    sensor: array, of whole lenslets, lens, and an odd number of views. pupil: cells along the pupil's diameter, a
    multiple of the views. Returns Projection: of one channel; a sample is the mean of its view over the lenslet, times
    that cell's share of the light.
    """
    views = sensor.optics.views
    every = open_weights(sensor.optics, pupil) * views**2 * _cells(views, pupil)
    order = np.arange(views**2).reshape(1, views, views)
    return Projection(sensor.shape, every, order, np.ones(views**2, bool), side=views)


def _cells(views: int, pupil: int) -> Floats:
    """Cells of the pupil that belong to each view, 1 or 0, (views**2, pupil, pupil)."""
    if pupil % views:
        raise ParameterError(f"pupil = {pupil}: must be a multiple of {views} views")
    some = np.kron(np.eye(views), np.ones(pupil // views))
    return np.einsum("va,ub->vuab", some, some).reshape(-1, pupil, pupil)


def mask_code(count: int = 1, high: int = MASK, wide: int = MASK) -> Floats:
    """Random codes of a mask, half of whose cells of a pixel's size are open.

    count: codes. high, wide: cells of their period; their product is even. Returns (count, high, wide), 1 or 0.
    """
    rng = np.random.default_rng(SEED)
    cells = np.arange(high * wide) % 2
    return np.array([rng.permutation(cells).reshape(high, wide) for _ in range(count)], float)


def mask(
    sensor: SensorParameters, pupil: int, codes: npt.NDArray[np.floating] | None = None, shift: float = SHIFT
) -> Projection:
    """Open pixels behind a mask at a distance at which a view step moves it by ``shift`` pixels.

    sensor: array and lens. pupil: cells along the pupil's diameter. codes: (codes, high, wide), transmission of the
    mask's cells, one code for each of several exposures; None is one `mask_code`. shift: px of the mask a view step.
    Returns a channel for each code. Transmission is linear between the middles of cells: pixels are as wide as these.
    Source: [Marwah2013].
    """
    codes = mask_code() if codes is None else np.asarray(codes, float)
    count, high, wide = codes.shape
    steps = (np.arange(pupil) - (pupil - 1) / 2) * sensor.optics.views / pupil * shift
    down, across = (_between(length, steps) for length in (high, wide))
    seen = np.einsum("yva,xub,cab->cyxvu", down, across, codes / codes.mean())
    weights = (seen * open_weights(sensor.optics, pupil)).reshape(-1, pupil, pupil)
    weights /= weights.sum((1, 2)).mean()
    order = np.arange(len(weights)).reshape(count, high, wide)
    return Projection(sensor.shape, weights, order, np.ones(len(weights), bool))


def _between(length: int, steps: Floats) -> Floats:
    """Weights of the cells of a period at each cell plus each step, linear between, (cells, steps, cells)."""
    place = np.arange(length)[:, None] + steps
    whole = np.floor(place).astype(int)
    part = (place - whole)[..., None]
    unit = np.eye(length)
    return (1 - part) * unit[whole % length] + part * unit[(whole + 1) % length]


def random(
    sensor: SensorParameters, pupil: int, channels: int = DIODES, period: tuple[int, int] | None = None
) -> Projection:
    """Random projections: every sample weighs each view by a random number, which no optics does.

    sensor: array, tile and lens. pupil: cells along the pupil's diameter, a multiple of the views. channels: samples of
    a pixel, 1..RANDOM. period: rows and columns after which the pixels repeat; None is as the tile. Returns Projection:
    of RANDOM responses, different ones in a pixel. Source: [Jayasuriya2017], Sec. 3.7.3.
    """
    rng, views = np.random.default_rng(SEED), sensor.optics.views
    drawn = rng.random((RANDOM, views**2)) @ _cells(views, pupil).reshape(views**2, -1)
    weights = drawn.reshape(-1, pupil, pupil) * open_weights(sensor.optics, pupil)
    weights /= weights.sum((1, 2)).mean()
    tile = sensor.tile
    high, wide = period or (tile.rows, tile.cols)
    order = np.array([rng.permutation(RANDOM)[:channels] for _ in range(high * wide)])
    order = order.T.reshape(channels, high, wide)
    return Projection(sensor.shape, weights, order, np.ones(RANDOM, bool), block=(tile.rows, tile.cols))


def asp(sensor: SensorParameters, pupil: int) -> Projection:
    """Angle-sensitive pixels, both diodes of each.

    sensor: the sensor; its lens counts as telecentric. pupil: cells along the pupil's diameter. Returns Projection: of
    two channels: response 2 t and 2 t + 1 are the diodes of type t.
    """
    tile = sensor.tile
    weights = view_weights(tile, replace(sensor.optics, views=pupil)).reshape(-1, pupil, pupil)
    order = 2 * tile.type_map(tile.rows, tile.cols) + np.arange(2)[:, None, None]
    return Projection(sensor.shape, weights, order, np.ones(len(weights), bool))


CAMERAS: Mapping[str, Callable[[SensorParameters, int], Projection]] = {
    "asp": asp,
    "lenslets": lenslets,
    "mask": mask,
    "random": random,
    "plain": plain,
}
