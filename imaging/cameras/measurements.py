"""Number of measurements a pixel, random and regular tiles [Jayasuriya2017, Fig. 3.15 and 3.16].

As in the thesis, samples are those of the light field's own views with Gaussian noise, without a chip: what a number of
measurements is worth where each has the same noise.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from talbot.imaging.cameras.measure import DISPARITIES, scenes_of, sensor_of
from talbot.imaging.frame.light_field import tried
from talbot.models.capture import cameras
from talbot.models.capture.projection import Projection
from talbot.models.parameters import SensorParameters
from talbot.models.reconstruct import psnr_db
from talbot.models.reconstruct.bayes import FieldEstimator, FieldPrior
from talbot.models.reconstruct.bayes.estimator import sums_and_differences

VIEWS = 25  # of a pixel
COUNTS = 0.5, 1, 2, 4, 8, 25  # measurements a pixel: 2 to 100 %
REGULAR, RANDOM = TILES = "regular", "random"
KINDS = "asp", "mask", "random"
PERIOD = (8, 12)  # px of random tiles, four of the sensor's
# Most measurements of a mask and of random tiles: the others take too long
MOST = {("mask", REGULAR): 8, ("asp", RANDOM): 2, ("mask", RANDOM): 2, ("random", RANDOM): 2}
MARGINS = {0.5: 4, 1: 4, 2: 4, 4: 3, 8: 2, 25: 1}  # px around a block, of about as many samples
SEED = 1
SIZE = 60  # pixels of a side


def points() -> list[tuple[str, str, float]]:
    """Return camera, tile and measurements a pixel of every point."""
    return [
        (kind, tile, count)
        for kind in KINDS
        for tile in TILES
        for count in COUNTS
        if count <= MOST.get((kind, tile), VIEWS)
    ]


def projection(kind: str, tile: str, count: float, sensor: SensorParameters) -> Projection:
    """Return the map of a camera with ``count`` measurements a pixel; with half a one every other pixel has none.

    tile: REGULAR, of the sensor's size, or RANDOM, four times that.
    """
    channels, views = max(int(count), 1), sensor.optics.views
    block = sensor.tile.rows, sensor.tile.cols
    period = block if tile == REGULAR else PERIOD
    if kind == "mask":
        camera = replace(cameras.mask(sensor, views, cameras.mask_code(channels, *period)), block=block)
    elif kind == "random":
        camera = cameras.random(sensor, views, channels, period)
    else:
        camera = _asp(tile, channels, sensor)
    return _half(camera) if count < 1 else camera


def _asp(tile: str, channels: int, sensor: SensorParameters) -> Projection:
    """Sums and differences of types; a single measurement is a diode. A pixel has the types that follow its first."""
    types, rng = sensor.tile.n_types, np.random.default_rng(SEED)
    standard = sensor.tile.type_map(sensor.tile.rows, sensor.tile.cols)
    first = standard if tile == REGULAR else rng.integers(0, types, PERIOD)
    step = np.arange(channels)
    order = 2 * ((first + step[:, None, None] // 2 * 7) % types) + (step % 2)[:, None, None]
    camera = sums_and_differences(sensor, sensor.optics.views)
    if channels == 1:
        camera = cameras.asp(sensor, sensor.optics.views)
    return replace(camera, order=order, block=(sensor.tile.rows, sensor.tile.cols))


def _half(camera: Projection) -> Projection:
    """Return the camera with every other pixel on a checkerboard blind: the response after the others."""
    blind = len(camera.weights)
    y, x = np.indices(camera.period)
    return replace(
        camera,
        weights=np.concatenate([camera.weights, np.zeros((1, *camera.weights.shape[1:]))]),
        order=np.where((y + x) % 2, blind, camera.order),
        telling=np.append(camera.telling, False),
    )


def measured(point: tuple[str, str, float], names: Sequence[str]) -> dict[str, Any]:
    """Return the PSNR of the views at a point, the mean over scenes in dB."""
    kind, tile, count = point
    sensor = sensor_of(SIZE)
    camera = projection(kind, tile, count, sensor)
    every: dict[str, Any] = {**DISPARITIES, **tried(sensor.optics.views, None, None)}
    prior = FieldPrior(margin=MARGINS[count], **every)
    prior = replace(prior, disparities=(prior.disparities + 1) // 2)
    read = np.asarray(camera.weights.any((1, 2)), bool)
    estimator = FieldEstimator(camera, sensor.optics.views, prior, measured=read)
    every_psnr = []
    for scene in scenes_of(names, sensor).values():
        truth = np.asarray(scene.full_light_field)
        samples = camera.forward(truth)
        samples += prior.noise * np.random.default_rng(SEED).standard_normal(samples.shape)
        every_psnr.append(psnr_db(estimator.mixture(samples).light_field, truth))
    return {
        "camera": kind,
        "tile": tile,
        "measurements": count,
        "share": count / VIEWS,
        "psnr_db": float(np.mean([psnr for psnr in every_psnr if psnr is not None])),
    }
