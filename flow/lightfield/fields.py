"""What a raw frame gives by every method, with its figures, beside what costs nothing."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.flow.frame.reading import about, full, rms
from talbot.flow.frame.result import GoldenResult
from talbot.models.capture import CaptureOperator, cells
from talbot.models.parameters import ParameterError, SensorParameters
from talbot.models.reconstruct import diode_noise, psnr_db, white_sum
from talbot.models.reconstruct.bad_pixels import dead_pixels, repaired
from talbot.models.reconstruct.bayes import Estimate, FieldEstimator, FieldPrior
from talbot.models.scene import Sampling
from talbot.models.scene.camera import depth as depth_of_disparity

from .methods import Found, applicable, figures, measure

Values = npt.NDArray[np.floating]
BEST = "mixture"  # the method whose pictures and disparity are shown
PUPIL = 7  # points across the pupil at which the estimators take a scene that can be seen from anywhere
SURE = 0.5  # px per view step: a disparity of a larger standard deviation is none


@dataclass(frozen=True, eq=False)
class Fields:
    """What one raw frame gives. found: by method. best: by `BEST`."""

    result: GoldenResult
    truth: Values
    found: Mapping[str, Found]
    best: Estimate
    summary: dict[str, Any]


def read_back(result: GoldenResult, prior: FieldPrior, note: Callable[[str], None] = lambda text: None) -> Fields:
    """Every method on the samples of a raw frame, and on the same samples without noise and converter.

    Raises ParameterError for a frame that does not read all of the array.
    """
    estimator, scene = estimator_of(result, prior), result.exposed.scene
    truth = np.asarray(scene.full_light_field, np.float32)
    sent, bad = sent_pair(result)
    ideal = pair_of(result, result.exposed.ideal)
    operator, corners = CaptureOperator(result.sensor), reached(result)
    seen = truth * corners
    free, found, figured = baselines(result.image, seen), {}, {}
    for name in applicable(operator):
        note(name)
        got, seconds = measure(name, estimator, operator, sent)
        got = _unsure(got, bad, estimator)
        float_got = measure(name, estimator, operator, ideal)[0]
        found[name] = got._replace(light_field=got.light_field * corners)
        figured[name] = figures(got.light_field * corners, seen, free["sum_image_psnr_db"]) | seconds
        figured[name]["left_out"] = got.plain
        figured[name]["psnr_db_float"] = psnr_db(float_got.light_field * corners, seen)
    summary = about(result) | {"methods": figured, "best": BEST, "baselines": free}
    if result.request.calibration:
        note("with the true optics")
        summary["true_optics"] = _by_truth(result, prior, truth * corners, sent)
    field, disparity, spread, plain = found[BEST]
    assert disparity is not None and spread is not None
    best = Estimate(field, disparity, spread, plain)
    return Fields(result, truth, found, best, summary | depth_figures(result, best))


def _by_truth(result: GoldenResult, prior: FieldPrior, seen: Values, sent: Values) -> dict[str, float | None]:
    """PSNR in dB of every method that knows the sensor's true optics in place of a calibration."""
    true = replace(result, request=replace(result.request, calibration=None))
    estimator, operator, corners = estimator_of(true, prior), CaptureOperator(true.sensor), reached(true)
    found = {name: measure(name, estimator, operator, sent)[0].light_field for name in applicable(operator)}
    return {name: psnr_db(field * corners, seen) for name, field in found.items()}


def estimate(result: GoldenResult, method: str = BEST, prior: FieldPrior | None = None) -> Found:
    """The light field of a raw frame by an `applicable` method. prior: by default `prior_of` the frame.

    Raises ParameterError as `read_back`.
    """
    prior = prior or prior_of(result)
    sent, bad = sent_pair(result)
    estimator = estimator_of(result, prior)
    found = _unsure(measure(method, estimator, CaptureOperator(result.sensor), sent)[0], bad, estimator)
    return found._replace(light_field=found.light_field * reached(result))


def prior_of(result: GoldenResult, **rest: Any) -> FieldPrior:
    """The prior of a frame: the noise of its sensor in its mean light, its contrast. rest: other of its fields."""
    asked = result.request
    timing = asked.frame.exposing
    light = result.decoded.samples.mean() / white_sum(asked.lit, timing)
    noise = float(diode_noise(light, asked.lit, timing, asked.noise))
    prior = FieldPrior(noise=max(noise, FieldPrior.noise), **rest)  # a scene is never as even as the prior's planes
    return replace(prior, contrast=prior.contrast_of(pair_of(result, result.decoded.samples).mean(0), noise))


def estimator_of(result: GoldenResult, prior: FieldPrior) -> FieldEstimator:
    """The estimator for a frame that reads all of the array. Raises ParameterError for another."""
    if not result.decoded.read.all():
        raise ParameterError("window, types, decimation = a part of the array: must be all, for a light field")
    scene = result.exposed.scene
    return _estimator(result.sensor, scene.views, prior, scene.views if scene.render is None else PUPIL)


@lru_cache(maxsize=1)  # with what it makes once a sensor, for the next method or frame
def _estimator(sensor: SensorParameters, views: int, prior: FieldPrior, pupil: int) -> FieldEstimator:
    return FieldEstimator(sensor, views, prior, pupil)


def sent_pair(result: GoldenResult) -> tuple[Values, npt.NDArray[np.bool_]]:
    """Samples of a raw frame as `pair_of`, dead pixels repaired, and the pixels that are dead or full."""
    samples = result.decoded.samples
    pair = pair_of(result, samples)
    dead = dead_pixels(pair)
    return repaired(pair, dead), dead | full(np.asarray(samples, float), (2,))


def _unsure(found: Found, bad: npt.NDArray[np.bool_], estimator: FieldEstimator) -> Found:
    """``found`` without a disparity wherever a window holds a bad pixel."""
    if found.spread is None or not bad.any():
        return found
    return found._replace(spread=np.where(estimator.told_by(bad), np.inf, found.spread))


def pair_of(result: GoldenResult, samples: npt.NDArray[Any]) -> Values:
    """Samples (rows, cols, 2) as (2, rows, cols), 1 = the average diode in a flat white scene."""
    white = white_sum(result.request.lit, result.request.frame.exposing)
    return np.moveaxis(np.asarray(samples, float), 2, 0) / white


def reached(result: GoldenResult) -> npt.NDArray[np.bool_]:
    """Corners that the round pupil does not reach have no light."""
    return cells(result.exposed.scene.views)[..., None, None]


def baselines(image: Values, truth: Values) -> dict[str, float | None]:
    """What costs nothing: the sum image in every view, and the mean of it."""
    gray = np.full(truth.shape, image.mean(), np.float32)
    copied = np.broadcast_to(image, truth.shape)
    return {"sum_image_psnr_db": psnr_db(copied, truth), "gray_psnr_db": psnr_db(gray, truth)}


def depth_figures(result: GoldenResult, found: Estimate) -> dict[str, float | None]:
    """Error of disparity and depth where the method is sure of them, beside that of one value for all.

    range_m: from the nearest to the farthest of the scene. sure: share of the pixels.
    """
    scene = result.exposed.scene
    names = ("disparity_rms_px", "disparity_median_px", "disparity_rms_constant_px", "depth_rms_m")
    out: dict[str, float | None] = dict.fromkeys((*names, "depth_rms_constant_m", "range_m", "depth_sure"))
    sure = found.spread <= SURE
    out["depth_sure"] = float(sure.mean())
    if scene.disparity is None or not sure.any():
        return out
    error = np.abs(found.disparity - scene.disparity)[sure]
    out["disparity_rms_px"] = rms(error)
    out["disparity_median_px"] = float(np.median(error))
    out["disparity_rms_constant_px"] = float(np.std(scene.disparity[sure]))
    if scene.depth is not None:
        depth = depth_map(result, found)
        out["depth_rms_m"] = rms((depth - scene.depth)[sure])
        out["depth_rms_constant_m"] = float(np.std(scene.depth[sure]))
        out["range_m"] = float(np.ptp(scene.depth))
    return out


def depth_map(result: GoldenResult, found: Estimate) -> Values:
    """Depth from the camera in m, (rows, cols)."""
    return depth_of_disparity(found.disparity, Sampling.of(result.sensor))
