"""Calibration on a bench: pixel types, trims, lens from frames alone."""

from talbot.models.calibrate.calibration import Calibration, read_calibration
from talbot.models.calibrate.fit import TypeFit, calibrated, fit_pupil, fit_types
from talbot.models.calibrate.sweep import Sweep, block_means, sunflower

__all__ = [
    "Calibration",
    "Sweep",
    "TypeFit",
    "block_means",
    "calibrated",
    "fit_pupil",
    "fit_types",
    "read_calibration",
    "sunflower",
]
