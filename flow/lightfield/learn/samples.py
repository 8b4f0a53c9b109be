"""Scenes to learn from, dead leaves and planes of them, and what the Bayes estimators make of their samples."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.ndimage import gaussian_filter, map_coordinates, spline_filter

from talbot.base.progress import each
from talbot.models.capture import CaptureOperator, cells
from talbot.models.parameters import ArrayParameters, SensorParameters
from talbot.models.reconstruct.bayes import FieldEstimator, FieldPrior
from talbot.models.reconstruct.network import NOISE, VIEWS, features
from talbot.models.scene import Sampling, load

Values = npt.NDArray[np.floating]
View = Callable[[float, float], Values]  # at an offset in view steps
SIZE = 96  # px: 4 x 4 tiles of 4 x 6 pixels and more
AROUND = 12  # px around a plane, that other views show
BLUR, BLURS = 0.7, (0.5, 2.5)  # px: of leaves, and the range of a plane's
DEEP, SLOPE = 1.6, 1.2  # px per view step: greatest disparity of a plane's middle, and of its ends less that
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


def light_fields(seeds: Sequence[int], size: int = SIZE) -> Iterator[Values]:
    """Truth of each seed's scene (see `Shot`): by turns dead leaves, the same blurred by a lens, a slanted plane."""
    return (_truth(_view(seed, size)) for seed in seeds)


def shots(seeds: Sequence[int], size: int = SIZE) -> Iterator[Shot]:
    """The scenes of `light_fields`, and what the diodes see of them."""
    own = sensor(size)
    operator = CaptureOperator(replace(own, optics=replace(own.optics, views=PUPIL)))
    for view in (_view(seed, size) for seed in seeds):
        yield Shot(_truth(view), operator.forward(_field(view, _offsets(PUPIL) * VIEWS / PUPIL)))


def _view(seed: int, size: int) -> View:
    return _plane(seed, size) if seed % 3 == 2 else _leaves(seed, size, BLUR * (seed % 3))


def _truth(view: View) -> Values:
    return _field(view, _offsets(VIEWS)) * cells(VIEWS)[..., None, None]


def _field(view: View, steps: Values) -> Values:
    """Views at ``steps`` both ways."""
    return np.array([[view(dv, du) for du in steps] for dv in steps])


def _offsets(count: int) -> Values:
    return np.arange(count) - (count - 1) / 2


def _leaves(seed: int, size: int, blur: float) -> View:
    """Views of dead leaves, blurred by a Gaussian of ``blur`` px."""
    see = load(f"leaves:{seed}", Sampling.of(sensor(size))).view(np.ones((size, size), bool))
    return lambda dv, du: gaussian_filter(see(dv, du)[0], blur) if blur else see(dv, du)[0]


def _plane(seed: int, size: int) -> View:
    """Views of a slanted plane: a picture of dead leaves, blurred, whose disparity is linear in the pixel's place."""
    rng, wide = np.random.default_rng(seed), size + 2 * AROUND
    image = load(f"leaves:{seed}", Sampling.of(sensor(wide))).image.astype(float)
    image = spline_filter(gaussian_filter(image, rng.uniform(*BLURS)))
    middle, down, across = rng.uniform(-DEEP, DEEP), *rng.uniform(-SLOPE, SLOPE, 2) / size
    y, x = np.indices((size, size)) - (size - 1) / 2

    def view(dv: float, du: float) -> Values:
        disparity = (middle + down * y + across * x) / (1 - dv * down - du * across)  # of the point that is seen here
        places = np.stack([y + dv * disparity, x + du * disparity]) + (wide - 1) / 2
        return map_coordinates(image, places, prefilter=False, mode="nearest")

    return view


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
        estimator = FieldEstimator(sensor(size), VIEWS, FieldPrior(noise=noise), ESTIMATED)
        for shot in each(taken, f"samples, noise {noise:g}"):
            pair = noisy(shot.pair, noise, rng)
            mixture = estimator.mixture(pair)
            seen = features(estimator.linear(pair), mixture, noise)
            wanted = ((shot.truth - mixture.light_field) * reached).reshape(-1, size, size)
            out.append(Lesson(seen.astype(np.float16), wanted.astype(np.float16)))
    return out
