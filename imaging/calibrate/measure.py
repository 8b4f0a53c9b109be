"""Errors of a calibration against the true optics, and their effect on a picture."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from time import perf_counter
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.imaging.calibrate.bench import Bench
from talbot.imaging.frame.job import golden_result, see
from talbot.imaging.frame.light_field import prior_of
from talbot.imaging.frame.request import FrameRequest
from talbot.imaging.lightfield.fields import read_back
from talbot.models.calibrate import Calibration, Sweep, TypeFit, calibrated
from talbot.models.parameters import SensorParameters
from talbot.models.pixel import optical_gains
from talbot.models.pixel.weights import density

Values = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Calibrated:
    """Result of the bench."""

    sweep: Sweep
    calibration: Calibration
    fits: list[TypeFit]
    summary: dict[str, Any]


def calibrate(request: FrameRequest, holes: int, note: Callable[[str], None] = lambda text: None) -> Calibrated:
    """Measure the chip of ``request`` on the bench, then read its scene back with the calibration and the truth."""
    see(request)  # a scene that cannot be read is refused at once
    note("bench")
    start = perf_counter()
    sweep = Bench(request, holes).sweep(note)
    middle = perf_counter()
    note("fit")
    calibration, pupil, fits = calibrated(sweep, request.sensor.array.pitch)
    end = perf_counter()
    note("picture")
    sensor = request.lit
    camera = sensor.optics.camera
    summary = {
        "rows": sensor.array.rows,
        "cols": sensor.array.cols,
        "holes": len(sweep.holes),
        "noise": request.noise,
        "seed": request.seed,
        "types": [_against(fit, kind, sensor) for fit, kind in zip(fits, sensor.tile.types, strict=True)],
        "gains_rms": _rms(np.array(calibration.gains) - optical_gains(sensor.tile, sensor.optics)),
        "response_rms": response_error(calibration, sensor, sweep.holes),
        "response_rms_constant": response_error(None, sensor, sweep.holes),
        "sigma": pupil.sigma,
        "sigma_true": sensor.optics.aperture_sigma,
        "pupil_power": calibration.pupil_power,
        "pupil_power_true": camera.pupil_power,
        "pupil_power_error": pupil.slope_error / sensor.array.pitch,
        "centre": calibration.centre,
        "condition": max(pupil.condition, *(fit.condition for fit in fits)),
        "seconds_bench": middle - start,
        "seconds_fit": end - middle,
        "picture": _picture(request, calibration),
    }
    return Calibrated(sweep, calibration, fits, summary)


def response_error(calibration: Calibration | None, sensor: SensorParameters, holes: Values) -> float:
    """RMS error of (a - b) / (a + b) over the types and the lens's cone; of no calibration: of 0."""
    y, x = holes.T
    ratio = [_ratio(sensor, y, x)]
    ratio.append(_ratio(calibration.applied(sensor), y, x) if calibration else np.zeros_like(ratio[0]))
    return _rms(ratio[1] - ratio[0])


def _ratio(sensor: SensorParameters, y: Values, x: Values) -> Values:
    a, b = np.moveaxis(density(sensor.tile.types, sensor.optics, x, y), 1, 0)
    return (a - b) / np.maximum(a + b, 1e-12)


def _against(fit: TypeFit, true: Any, sensor: SensorParameters) -> dict[str, Any]:
    kind, m = fit.kind, sensor.optics.m if true.m is None else true.m
    out = {f"{name}{end}": getattr(k, name) for name in ("beta", "gamma_deg", "alpha") for k, end in _ends(kind, true)}
    out |= {"m": kind.m, "m_true": m, "m_error": fit.m_error, "alpha_error": fit.alpha_error}
    return out | {"residual": fit.residual, "condition": fit.condition}


def _ends(kind: Any, true: Any) -> tuple[tuple[Any, str], ...]:
    return (kind, ""), (true, "_true")


def _picture(request: FrameRequest, calibration: Calibration) -> dict[str, Any]:
    """PSNR (dB) of the scene's light field by every method, with the calibration and with the true optics."""
    result = golden_result(replace(request, calibration=calibration))
    summary = read_back(result, prior_of(result)).summary
    methods = {name: figures["psnr_db"] for name, figures in summary["methods"].items()}
    return {"scene": request.name, "calibrated": methods, "true_optics": summary["true_optics"]} | summary["baselines"]


def _rms(error: Values) -> float:
    return float(np.sqrt(np.mean(error**2)))
