"""Methods that give a light field back from the diodes, by name, and their figures beside what costs nothing."""

from collections.abc import Callable, Mapping
from functools import lru_cache, partial
from time import perf_counter
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from skimage.metrics import structural_similarity

from talbot.models.capture import CaptureOperator
from talbot.models.parameters import SensorParameters
from talbot.models.reconstruct import light_field_estimate, psnr_db
from talbot.models.reconstruct.bayes import FieldEstimator
from talbot.models.reconstruct.branches import KINDS, Branches
from talbot.models.reconstruct.network import VIEWS, Network
from talbot.models.reconstruct.sparse import Coding, Dictionary, SparseEstimator

Values = npt.NDArray[np.floating]
SSIM_WINDOW = 7  # px


class Found(NamedTuple):
    """What a method gives.

    light_field: l[v, u, y, x], white = 1. disparity, spread: (rows, cols) in px, or None. plain: share of the windows
    that are left out, since their samples show no angular content.
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


def _network(estimator: FieldEstimator, operator: CaptureOperator, pair: Values) -> Found:
    mixture = estimator.mixture(pair)
    field = Network.shipped().correct(estimator.linear(pair), mixture, estimator.prior.noise)
    return Found(*mixture._replace(light_field=field))


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


# direct: Sigma^-1 Phi' i [Jayasuriya2017, Sec. 3.3.2]. linear, mixture: models/reconstruct/bayes. autoencoder and
# convolutions: the branches of two_branch, each alone [Jayasuriya2017, Sec. 3.7]
BRANCHES = dict(zip(("autoencoder", "convolutions", "two_branch"), KINDS, strict=True))
METHODS: Mapping[str, Method] = {
    "direct": _direct,
    "linear": _linear,
    "sparse": _sparse,
    **{name: partial(_branches, kind) for name, kind in BRANCHES.items()},
    "mixture": _mixture,
    "network": _network,
}
PREPARE: Mapping[str, Callable[[FieldEstimator, CaptureOperator], object]] = {
    "linear": lambda estimator, operator: estimator.prepare(),
    "sparse": _coder,
    "mixture": lambda estimator, operator: estimator.prepare(mixture=True),
    "network": lambda estimator, operator: (estimator.prepare(mixture=True), Network.shipped()),
    **dict.fromkeys(BRANCHES, lambda estimator, operator: Branches.shipped()),
}


def applicable(operator: CaptureOperator) -> list[str]:
    """Methods for frames of this size and light fields of as many views; what is learned has a size of its own."""
    views, _, *shape = operator.shape
    _, own, _, *patch = Dictionary.shipped().atoms.shape
    fits = {"network": views == VIEWS, "sparse": views == own and min(np.subtract(shape, patch)) >= 0}
    fits |= dict.fromkeys(BRANCHES, Branches.shipped().knows(operator.sensor))
    return [name for name in METHODS if fits.get(name, True)]


def measure(
    name: str, estimator: FieldEstimator, operator: CaptureOperator, pair: Values
) -> tuple[Found, dict[str, float]]:
    """Run a method.

    pair: (2, rows, cols), 1 = the average diode in a flat white scene. Returns what it gives, and seconds a frame with
    those that it takes once a sensor.
    """
    start = perf_counter()
    PREPARE.get(name, lambda estimator, operator: None)(estimator, operator)
    ready = perf_counter()
    found = METHODS[name](estimator, operator, pair)
    return found, {"seconds": perf_counter() - ready, "seconds_once": ready - start}


def figures(found: Values, truth: Values, free: float | None) -> dict[str, float | None]:
    """Of a light field against the true one: PSNR, SSIM (mean of the views), gain over the copied image, parallax.

    slope, correlation: of the difference of opposite outer views, horizontal and vertical, to the true one; None where
    the true views are equal. free: PSNR (dB) of the copied sum image, which the gain is against.
    """
    psnr = psnr_db(found, truth)
    slope, correlation = parallax(found, truth)
    gain = None if psnr is None or free is None else psnr - free
    return {"psnr_db": psnr, "ssim": ssim(found, truth), "gain_db": gain, "slope": slope, "correlation": correlation}


def ssim(found: Values, truth: Values) -> float | None:
    """Structural similarity, mean of the views; None where a view is smaller than the window."""
    if min(truth.shape[2:]) < SSIM_WINDOW:
        return None
    pairs = ((np.asarray(found[v, u], float), np.asarray(truth[v, u], float)) for v, u in np.ndindex(truth.shape[:2]))
    return float(np.mean([structural_similarity(a, b, data_range=1.0) for a, b in pairs]))


def parallax(found: Values, truth: Values) -> tuple[float | None, float | None]:
    """Slope and correlation of the found difference of the outermost middle views to the true one."""
    middle = len(truth) // 2
    a, b = (
        np.stack([field[middle, -1] - field[middle, 0], field[-1, middle] - field[0, middle]]).astype(float)
        for field in (found, truth)
    )
    own, true, shared = float((a * a).sum()), float((b * b).sum()), float((a * b).sum())
    if not true:
        return None, None
    return shared / true, shared / np.sqrt(own * true) if own else 0.0
