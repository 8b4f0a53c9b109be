"""The methods that give a light field back from the diodes, each by the name that it has everywhere.

direct      Sigma^-1 Phi' i [Jayasuriya2017, Sec. 3.3.2]
linear      `bayes`: one filter for windows of like disparities; the default
sparse      `sparse`
mixture     `bayes`: each pixel by its own disparity
layers      `layers`: surfaces with complete textures where they explain the samples, else mixture
two_branch  `branches`; autoencoder and convolutions are its branches, each alone [Jayasuriya2017, Sec. 3.7]
"""

from collections.abc import Callable, Mapping
from functools import lru_cache, partial
from time import perf_counter
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from talbot.models.capture import CaptureOperator
from talbot.models.parameters import ParameterError, SensorParameters
from talbot.models.reconstruct.bayes import FieldEstimator
from talbot.models.reconstruct.branches import KINDS, Branches
from talbot.models.reconstruct.layers import layered
from talbot.models.reconstruct.light_field import light_field_estimate
from talbot.models.reconstruct.sparse import Coding, Dictionary, SparseEstimator

Values = npt.NDArray[np.floating]
MOST_VIEWS = 9  # of `layers`, along the pupil's diameter: a frame of 384 x 384 pixels then has 1 GB
DEFAULT = "linear"  # as fast as direct once its filters are there, and it has parallax


class Found(NamedTuple):
    """The result of a method.

    light_field: (views, views, rows, cols), l[v, u, y, x], white = 1; noise and error take it below 0.
    disparity, spread: (rows, cols), in px per view step, and its standard deviation; None of a method that tells none.
    plain: share of the windows that are left out, since their samples show no angular content.
    """

    light_field: Values
    disparity: Values | None = None
    spread: Values | None = None
    plain: float = 0.0


Method = Callable[[FieldEstimator, CaptureOperator, Values], Found]


def _direct(estimator: FieldEstimator, operator: CaptureOperator, pair: Values) -> Found:
    return Found(light_field_estimate(operator, pair.astype(operator.dtype)))


def _linear(estimator: FieldEstimator, operator: CaptureOperator, pair: Values) -> Found:
    return Found(estimator.linear(pair))


def _mixture(estimator: FieldEstimator, operator: CaptureOperator, pair: Values) -> Found:
    return Found(*estimator.mixture(pair))


def _layers(estimator: FieldEstimator, operator: CaptureOperator, pair: Values) -> Found:
    estimate = estimator.mixture(pair)
    field = layered(estimate, operator.sensor, estimator.pupil, estimator.prior.noise, pair)
    return Found(*estimate._replace(light_field=field))


def _branches(kind: str, estimator: FieldEstimator, operator: CaptureOperator, pair: Values) -> Found:
    return Found(Branches.shipped().estimate(pair, operator.sensor, estimator.prior.noise, kind))


def _sparse(estimator: FieldEstimator, operator: CaptureOperator, pair: Values) -> Found:
    return Found(_coder(estimator, operator).estimate(pair))


def _coder(estimator: FieldEstimator, operator: CaptureOperator) -> SparseEstimator:
    return _prepared(operator.sensor, Coding(noise=estimator.prior.noise))


@lru_cache(maxsize=1)
def _prepared(sensor: SensorParameters, coding: Coding) -> SparseEstimator:
    coder = SparseEstimator(sensor, coding)
    coder.prepare()
    return coder


BRANCHES = dict(zip(("autoencoder", "convolutions", "two_branch"), KINDS, strict=True))
METHODS: Mapping[str, Method] = {
    "direct": _direct,
    "linear": _linear,
    "sparse": _sparse,
    **{name: partial(_branches, kind) for name, kind in BRANCHES.items()},
    "mixture": _mixture,
    "layers": _layers,
}
PREPARE: Mapping[str, Callable[[FieldEstimator, CaptureOperator], object]] = {
    "linear": lambda estimator, operator: estimator.prepare(),
    "sparse": _coder,
    **dict.fromkeys(("mixture", "layers"), lambda estimator, operator: estimator.prepare(mixture=True)),
    **dict.fromkeys(BRANCHES, lambda estimator, operator: Branches.shipped()),
}
ANY_TYPES = "direct", "linear", "mixture"  # know what to do where some pixel types are not read


def applicable(operator: CaptureOperator) -> list[str]:
    """Methods for frames of this size and light fields of as many views; learned methods have a fixed size.

    operator: operator of all views. Returns list of str: their names, in the order of `METHODS`.
    """
    views, _, *shape = operator.shape
    _, trained, _, *patch = Dictionary.shipped().atoms.shape
    fits = {"sparse": views == trained and min(np.subtract(shape, patch)) >= 0}
    fits["layers"] = views <= MOST_VIEWS
    fits |= dict.fromkeys(BRANCHES, Branches.shipped().knows(operator.sensor))
    return [name for name in METHODS if fits.get(name, True)]


def check_method(name: str, operator: CaptureOperator) -> None:
    """Check that a method is there, and for frames of this size.

    name: of the method. operator: as for `applicable`. Raises ParameterError with the list of those that are.
    """
    if name not in METHODS:
        raise ParameterError(f"method = {name!r}: must be one of {', '.join(METHODS)}")
    if name not in applicable(operator):
        views, _, rows, cols = operator.shape
        raise ParameterError(
            f"method = {name!r}: must be one of {', '.join(applicable(operator))} for {views} x {views} views of "
            f"{rows} x {cols} pixels and this tile"
        )


def measure(
    name: str, estimator: FieldEstimator, operator: CaptureOperator, pair: Values
) -> tuple[Found, dict[str, float]]:
    """Run a method.

    name: one of `METHODS`. estimator: of the sensor, with the prior. operator: of the same sensor, all views. pair: (2,
    rows, cols), 1 = the average diode in a flat white scene. Returns Found: what it gives. Returns ``seconds`` a frame,
    and ``seconds_once``, those that it takes once a sensor.
    """
    start = perf_counter()
    PREPARE.get(name, lambda estimator, operator: None)(estimator, operator)
    ready = perf_counter()
    result = METHODS[name](estimator, operator, pair)
    return result, {"seconds": perf_counter() - ready, "seconds_once": ready - start}
