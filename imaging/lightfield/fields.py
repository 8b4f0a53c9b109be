"""Light fields of a raw frame by every method, with figures and a baseline that costs nothing."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.base.progress import each
from talbot.imaging.frame.light_field import SURE, estimator_of, pair_of, reached, sent_pair, unsure
from talbot.imaging.frame.quality import clear_psnr_db
from talbot.imaging.frame.reading import about, rms
from talbot.imaging.frame.result import GoldenResult
from talbot.imaging.lightfield.figures import figures
from talbot.models.capture import CaptureOperator
from talbot.models.parameters import ParameterError, check_choice
from talbot.models.reconstruct.bayes import Estimate, FieldPrior
from talbot.models.reconstruct.methods import METHODS, Found, applicable, check_method, measure
from talbot.models.scene import Sampling
from talbot.models.scene.camera import depth as depth_of_disparity

Values = npt.NDArray[np.floating]
BEST = "layers", "mixture"  # the first of them that runs: its pictures and disparity are shown
STANDARD = ("direct", "linear", "mixture")  # what is always run: the others take more time and have no higher PSNR
ALL = "all"


@dataclass(frozen=True, eq=False)
class Fields:
    """Light fields of a raw frame. found: by method. best: by `BEST`."""

    result: GoldenResult
    truth: Values
    found: Mapping[str, Found]
    best: Estimate
    summary: dict[str, Any]


def methods_of(text: str) -> list[str]:
    """Return the methods that ``text`` names, with commas, or all, and those of STANDARD. Raises ParameterError."""
    words = [word for word in text.replace(",", " ").split() if word != ALL]
    for word in words:
        check_choice("method", word, (ALL, *METHODS))
    return [name for name in METHODS if name in (*STANDARD, *words) or ALL in text.replace(",", " ").split()]


def read_back(
    result: GoldenResult,
    prior: FieldPrior,
    note: Callable[[str], None] = lambda text: None,
    methods: Sequence[str] = STANDARD,
) -> Fields:
    """Light fields of the samples of a raw frame, and of the same samples without noise and converter.

    methods: names of METHODS, STANDARD among them; all of METHODS are those that are `applicable`. Raises
    ParameterError for a frame that does not read all of the array, and for a method that does not fit it.
    """
    if not result.decoded.read.all():
        raise ParameterError("window, types, decimation = a part of the array: must be all, for every method")
    estimator, scene = estimator_of(result, prior), result.exposed.scene
    truth = np.asarray(scene.full_light_field, np.float32)
    sent, bad = sent_pair(result)
    ideal = pair_of(result, result.exposed.ideal)
    operator, corners = CaptureOperator(result.sensor), reached(result)
    seen = truth * corners
    methods = applicable(operator) if set(methods) == {*METHODS} else methods
    for name in methods:
        check_method(name, operator)
    clear = result.counted
    free, estimates, figured = baselines(result.image, seen, clear), {}, {}
    for name in each(methods, "method", str):
        got, seconds = measure(name, estimator, operator, sent)
        got = unsure(got, bad, estimator)
        float_got = measure(name, estimator, operator, ideal)[0]
        estimates[name] = got._replace(light_field=got.light_field * corners)
        figured[name] = figures(got.light_field * corners, seen, free["sum_image_psnr_db"], clear) | seconds
        figured[name]["left_out"] = got.plain
        figured[name]["psnr_db_float"] = clear_psnr_db(float_got.light_field * corners, seen, clear)
    shown = next(name for name in BEST if name in estimates)
    summary = about(result) | {"methods": figured, "best": shown, "baselines": free}
    if result.request.calibration:
        note("with the true optics")
        summary["true_optics"] = _by_truth(result, prior, truth * corners, sent, methods)
    field, disparity, spread, plain = estimates[shown]
    assert disparity is not None and spread is not None
    best = Estimate(field, disparity, spread, plain)
    return Fields(result, truth, estimates, best, summary | depth_figures(result, best))


def _by_truth(
    result: GoldenResult, prior: FieldPrior, seen: Values, sent: Values, methods: Sequence[str]
) -> dict[str, float | None]:
    """PSNR in dB of the methods that know the sensor's true optics instead of a calibration."""
    true = replace(result, request=replace(result.request, calibration=None))
    estimator, operator, corners = estimator_of(true, prior), CaptureOperator(true.sensor), reached(true)
    estimates = {name: measure(name, estimator, operator, sent)[0].light_field for name in methods}
    return {name: clear_psnr_db(field * corners, seen, true.counted) for name, field in estimates.items()}


def baselines(image: Values, truth: Values, clear: npt.NDArray[np.bool_]) -> dict[str, float | None]:
    """Return the baselines: the sum image in every view, and its mean. clear: pixels that count, (rows, cols)."""
    gray = np.full(truth.shape, image.mean(), np.float32)
    copied = np.broadcast_to(image, truth.shape)
    return {"sum_image_psnr_db": clear_psnr_db(copied, truth, clear), "gray_psnr_db": clear_psnr_db(gray, truth, clear)}


def depth_figures(result: GoldenResult, estimate: Estimate) -> dict[str, float | None]:
    """Return the error of disparity and depth where the method marks them as reliable, and that of one value for all.

    range_m: from the nearest to the farthest of the scene. sure: share of the pixels.
    """
    scene = result.exposed.scene
    names = ("disparity_rms_px", "disparity_median_px", "disparity_rms_constant_px", "depth_rms_m")
    out: dict[str, float | None] = dict.fromkeys((*names, "depth_rms_constant_m", "range_m", "depth_sure"))
    sure = estimate.spread <= SURE
    out["depth_sure"] = float(sure.mean())
    if scene.disparity is None or not sure.any():
        return out
    error = np.abs(estimate.disparity - scene.disparity)[sure]
    out["disparity_rms_px"] = rms(error)
    out["disparity_median_px"] = float(np.median(error))
    out["disparity_rms_constant_px"] = float(np.std(scene.disparity[sure]))
    if scene.depth is not None:
        depth = depth_map(result, estimate)
        out["depth_rms_m"] = rms((depth - scene.depth)[sure])
        out["depth_rms_constant_m"] = float(np.std(scene.depth[sure]))
        out["range_m"] = float(np.ptp(scene.depth))
    return out


def depth_map(result: GoldenResult, estimate: Estimate) -> Values:
    """Depth from the camera in m, (rows, cols)."""
    return depth_of_disparity(estimate.disparity, Sampling.of(result.sensor))
