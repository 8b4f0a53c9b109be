"""Calibration on a bench: pixel types, trims, lens from frames alone."""

from .calibration import Calibration, read_calibration
from .fit import TypeFit, calibrated, fit_pupil, fit_types
from .sweep import Sweep, block_means

__all__ = ["Calibration", "Sweep", "TypeFit", "block_means", "calibrated", "fit_pupil", "fit_types", "read_calibration"]
