"""Figures of every camera on the same scenes, each with the same prior and estimator."""

from collections.abc import Sequence
from dataclasses import replace
from time import process_time
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.imaging.cameras.frames import captured, expose, fine, seconds_of
from talbot.imaging.frame.light_field import SURE, tried
from talbot.imaging.frame.reading import rms
from talbot.imaging.lightfield.figures import figures
from talbot.models.capture.cameras import CAMERAS
from talbot.models.parameters import STANDARD, SensorParameters
from talbot.models.reconstruct import psnr_db
from talbot.models.reconstruct.bayes import Estimate, FieldEstimator, FieldPrior
from talbot.models.reconstruct.bayes.estimator import LINEAR, MIXTURE
from talbot.models.reconstruct.bayes.prior import NOISE_MAX
from talbot.models.scene import Sampling, Scene, load

Values = npt.NDArray[np.floating]
SCENES = "tilted", "leaves:7", "coins", "motorcycle", "room"
TRAINING = "leaves:1", "leaves:2", "cornell"  # scenes that the plain camera's disparity is learned from
LUX = 500.0, 100.0, 20.0
COPIED, PLAIN, ASP = "copied", "plain", "asp"
# Cells of the pupil, and px around a block of pixels, of the estimators
PUPIL = {"asp": 7, "lenslets": 10, "mask": 10, "random": 10, "plain": 7}
MARGIN = {"asp": 4, "lenslets": 10, "mask": 4, "random": 4, "plain": 6}
# Every camera has the same prior: planes that face it
DISPARITIES: dict[str, Any] = {"disparities": 21, "between": 0, "slants": 0}
CANDIDATES = tuple(float(d) for d in np.linspace(-2, 2, 9))  # px a view step
NONE = float("inf")
MEAN = ", mean"  # of the posterior: parallax is not raised, which was set up for angle-sensitive pixels


def sensor_of(size: int) -> SensorParameters:
    """Return the default sensor with size x size pixels."""
    return replace(STANDARD, array=replace(STANDARD.array, rows=size, cols=size))


def scenes_of(names: Sequence[str], sensor: SensorParameters) -> dict[str, Scene]:
    """Return scenes by name. Raises ParameterError."""
    return {name: load(name, Sampling.of(sensor)) for name in names}


def learned(names: Sequence[str], size: int, lux: float) -> dict[str, Any]:
    """Learn the plain camera's disparity: that with the highest PSNR of the views of scenes, on average.

    Returns disparity, px per view step, and the PSNR in dB of each candidate.
    """
    sensor = sensor_of(size)
    seconds, curve = seconds_of(sensor, lux), []
    scenes = scenes_of(names, sensor)
    clean = {name: captured(scene, CAMERAS[PLAIN](sensor, fine(scene))) for name, scene in scenes.items()}
    frames = {name: expose(sensor, PLAIN, samples, lux, seconds, 1) for name, samples in clean.items()}
    noise = float(np.mean([frame.noise for frame in frames.values()]))
    for disparity in CANDIDATES:
        estimator = _estimator(sensor, PLAIN, noise, disparity)
        every = [
            psnr_db(estimator.linear(frames[name].samples), np.asarray(scene.full_light_field))
            for name, scene in scenes.items()
        ]
        curve.append(float(np.mean([psnr for psnr in every if psnr is not None])))
    return {"disparity": CANDIDATES[int(np.argmax(curve))], "psnr_db": curve}


def measured(
    name: str, names: Sequence[str], size: int, lux: float, brightest: float, seeds: int, disparity: float
) -> list[dict[str, Any]]:
    """Return the figures of a camera of `CAMERAS` in one light, a row a scene, seed and method.

    The plain camera's are those of its disparity, and of `COPIED`; the disparity of the others is always the mixture's.

    brightest: lux in which an open pixel's white gives the usual signal, which sets the exposure of all.
    disparity: of the plain camera.
    """
    sensor, rows = sensor_of(size), []
    seconds = seconds_of(sensor, brightest)
    scenes = scenes_of(names, sensor)
    clean = {key: captured(scene, CAMERAS[name](sensor, fine(scene))) for key, scene in scenes.items()}
    first = [expose(sensor, name, samples, lux, seconds, 1).noise for samples in clean.values()]
    start = process_time()
    estimator = _estimator(sensor, name, float(np.mean(first)), disparity)
    if name != PLAIN:
        estimator.prepare(mixture=True)
    once = process_time() - start
    for key, scene in scenes.items():
        truth = np.asarray(scene.full_light_field)
        for seed in range(1, seeds + 1):
            frame = expose(sensor, name, clean[key], lux, seconds, seed)
            about = {"scene": key, "lux": lux, "seed": seed, "snr_db": frame.snr_db, "bytes": frame.bytes}
            about |= {"energy_uj": frame.energy_uj, "exposure_s": frame.seconds, "seconds_once": once}
            for (camera, method), got in _estimates(estimator, name, frame.samples, disparity).items():
                rows.append({"camera": camera, "method": method} | about | _figures(got, scene, truth))
    return rows


def _estimator(sensor: SensorParameters, name: str, noise: float, disparity: float) -> FieldEstimator:
    every: dict[str, Any] = {**DISPARITIES, **tried(sensor.optics.views, None, None)}
    prior = FieldPrior(noise=min(max(noise, FieldPrior.noise), NOISE_MAX), margin=MARGIN[name], **every)
    views, pupil = sensor.optics.views, PUPIL[name]
    if name == ASP:
        return FieldEstimator(sensor, views, prior, pupil)
    if name == PLAIN:
        prior = replace(prior, far=disparity, near=disparity, disparities=1)
    return FieldEstimator(CAMERAS[name](sensor, pupil), views, prior)


def _estimates(
    estimator: FieldEstimator, name: str, samples: Values, disparity: float
) -> dict[tuple[str, str], Estimate]:
    """Return the estimates of a frame by camera and method, `MEAN` in the name of one without raised parallax."""
    linear, shape = estimator.linear(samples), estimator.shape
    if name == PLAIN:
        every = {"linear": Estimate(linear, np.full(shape, disparity), np.full(shape, NONE))}
    else:
        mixture = estimator.mixture(samples)
        every = {"mixture": mixture, "linear": mixture._replace(light_field=linear)}
    for method, raised in (("linear", LINEAR), ("mixture", MIXTURE)):
        if method in every:
            views = every[method].light_field
            mean = views.mean((0, 1))
            every[method + MEAN] = every[method]._replace(light_field=mean + (views - mean) / np.float32(raised))
    out = {(name, method): estimate for method, estimate in every.items()}
    if name == PLAIN:
        views = np.broadcast_to(samples[0], linear.shape)
        out[COPIED, "none"] = Estimate(views, np.zeros(shape), np.full(shape, NONE))
    return out


def _figures(got: Estimate, scene: Scene, truth: Values) -> dict[str, Any]:
    """Quality of views and disparity; None of a disparity that the scene does not know."""
    views = figures(got.light_field, truth, None)
    out: dict[str, Any] = {key: views[key] for key in ("psnr_db", "ssim", "slope")}
    out |= dict.fromkeys(("disparity_rms_px", "disparity_sure_rms_px", "constant_rms_px"))
    sure = got.spread <= SURE
    out["sure"] = float(sure.mean())
    if scene.disparity is None:
        return out
    error = got.disparity - scene.disparity
    out["disparity_rms_px"], out["disparity_sure_rms_px"] = rms(error), rms(error[sure])
    out["constant_rms_px"] = float(np.std(scene.disparity))
    return out
