"""Scenes to learn from: dead leaves and planes of them, and both diodes' samples of each."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.ndimage import gaussian_filter, map_coordinates, spline_filter

from talbot.models.capture import CaptureOperator, cells
from talbot.models.parameters import ArrayParameters, SensorParameters
from talbot.models.reconstruct.branches import VIEWS
from talbot.models.scene import Sampling, load

Values = npt.NDArray[np.floating]
View = Callable[[float, float], Values]  # at an offset in view steps
SIZE = 96  # px: 4 x 4 tiles of 4 x 6 pixels and more
AROUND = 12  # px around a plane, that other views show
BLUR, BLURS = 0.7, (0.5, 2.5)  # px: of leaves, and the range of a plane's
DEEP, SLOPE = 1.6, 1.2  # px per view step: greatest disparity of a plane's middle, and of its ends less that
PUPIL = 11  # points across the pupil at which a scene is captured


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
    """Return the standard sensor, of ``size`` x ``size`` pixels."""
    return SensorParameters(array=ArrayParameters(size, size))


def light_fields(seeds: Sequence[int], size: int = SIZE) -> Iterator[Values]:
    """Truth of each seed's scene (see `Shot`): by turns dead leaves, the same blurred by a lens, a slanted plane."""
    return (_truth(_view(seed, size)) for seed in seeds)


def shots(seeds: Sequence[int], size: int = SIZE) -> Iterator[Shot]:
    """Yield the scenes of `light_fields`, and what the diodes see of them."""
    chip = sensor(size)
    operator = CaptureOperator(replace(chip, optics=replace(chip.optics, views=PUPIL)))
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
    """Return the samples with Gaussian noise of this standard deviation."""
    return pair + noise * rng.standard_normal(pair.shape)
