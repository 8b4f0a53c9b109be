"""Scenes to learn from: dead leaves before the sensor, and what the Bayes estimators make of their noisy samples."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from talbot.base.progress import each
from talbot.flow.lightfield.fields import TRUST
from talbot.models.capture import CaptureOperator, cells
from talbot.models.parameters import ArrayParameters, SensorParameters
from talbot.models.reconstruct.bayes import FieldEstimator, FieldPrior
from talbot.models.reconstruct.network import NOISE, VIEWS, features
from talbot.models.scene import Sampling, load

Values = npt.NDArray[np.floating]
SIZE = 96  # px: 4 x 4 tiles of 4 x 6 pixels and more
PUPIL = 11  # points across the pupil at which a scene is captured
ESTIMATED = 7  # at which the estimators take it, as `make lightfield` does
NOISES = (
    NOISE[0],
    0.05,
    NOISE[1],
)  # of white: physical noise, to the most that the thesis tries [Jayasuriya2017, Sec. 3.7]


class Shot(NamedTuple):
    """A scene as it is and as the diodes see it without noise.

    Attributes
    ----------
    truth : float64 (5, 5, rows, cols)
        Light field, white = 1; 0 in the corners that the pupil does not reach.
    pair : float64 (2, rows, cols)
        Both diodes, 1 = the average diode in a flat white scene.
    """

    truth: Values
    pair: Values


def sensor(size: int = SIZE) -> SensorParameters:
    """The standard sensor, of ``size`` x ``size`` pixels."""
    return SensorParameters(array=ArrayParameters(size, size))


def shots(seeds: Sequence[int], size: int = SIZE) -> Iterator[Shot]:
    """Dead leaves of these seeds."""
    own = sensor(size)
    operator = CaptureOperator(replace(own, optics=replace(own.optics, views=PUPIL)))
    steps = (np.arange(PUPIL) - (PUPIL - 1) / 2) * VIEWS / PUPIL
    for seed in seeds:
        scene = load(f"leaves:{seed}", Sampling.of(own))
        see = scene.view(np.ones(scene.shape, bool))
        field = np.array([[see(dv, du)[0] for du in steps] for dv in steps])
        yield Shot(scene.full_light_field * cells(VIEWS)[..., None, None], operator.forward(field))


def noisy(pair: Values, noise: float, rng: np.random.Generator) -> Values:
    """The samples with Gaussian noise of this standard deviation."""
    return pair + noise * rng.standard_normal(pair.shape)


class Lesson(NamedTuple):
    """Inputs of the network and what it is to add, one scene at one noise.

    Attributes
    ----------
    seen : float16 (54, rows, cols)
        As of `models.reconstruct.network.features`.
    wanted : float16 (25, rows, cols)
        True light field less the mixture's.
    """

    seen: npt.NDArray[np.float16]
    wanted: npt.NDArray[np.float16]


def lessons(seeds: Sequence[int], seed: int, noises: Sequence[float] = NOISES, size: int = SIZE) -> list[Lesson]:
    """Scenes of ``seeds`` at every noise, the noise from ``seed``."""
    rng, out, taken = np.random.default_rng(seed), [], list(shots(seeds, size))
    reached = cells(VIEWS)[..., None, None]
    for noise in noises:
        estimator = FieldEstimator(sensor(size), VIEWS, FieldPrior(noise=noise, trust=TRUST), ESTIMATED)
        for shot in each(taken, f"samples, noise {noise:g}"):
            pair = noisy(shot.pair, noise, rng)
            mixture = estimator.mixture(pair)
            seen = features(estimator.linear(pair), mixture, noise)
            wanted = ((shot.truth - mixture.light_field) * reached).reshape(-1, size, size)
            out.append(Lesson(seen.astype(np.float16), wanted.astype(np.float16)))
    return out
