"""Peak signal-to-noise ratio."""

import numpy as np

from models.parameters import ParameterError


def psnr_db(found, truth, peak=1.0):
    """10 log10(peak^2 / mean squared error) in dB; None where both are equal everywhere (the ratio is infinite).

    found, truth: arrays of one shape. peak: above 0. Raises ParameterError for different shapes.
    """
    found, truth = np.asarray(found, float), np.asarray(truth, float)
    if found.shape != truth.shape or not found.size:
        raise ParameterError(f"shape = {found.shape}: must be {truth.shape}, and not empty")
    error = float(np.mean((found - truth) ** 2))
    return None if error == 0 else 10 * float(np.log10(peak**2 / error))


def psnr_without_mean_db(found, truth, peak=1.0):
    """The same after each has lost its mean: for images rebuilt from differences."""
    return psnr_db(found - np.mean(found), truth - np.mean(truth), peak)
