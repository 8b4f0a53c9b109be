"""Peak signal-to-noise ratio."""

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError


def psnr_db(estimate: npt.ArrayLike, truth: npt.ArrayLike, peak: float = 1.0) -> float | None:
    """Peak signal-to-noise ratio, 10 log10(peak^2 / mean squared error).

    estimate, truth: of one shape. peak: greater than 0. Returns float or None: in dB; None where both are equal
    everywhere (the ratio is infinite). Raises ParameterError for different or empty shapes.
    """
    estimate, truth = np.asarray(estimate, float), np.asarray(truth, float)
    if estimate.shape != truth.shape or not estimate.size:
        raise ParameterError(f"shape = {estimate.shape}: must be {truth.shape}, and not empty")
    error = float(np.mean((estimate - truth) ** 2))
    return None if error == 0 else 10 * float(np.log10(peak**2 / error))


def psnr_without_mean_db(estimate: npt.NDArray[np.floating], truth: npt.NDArray[np.floating]) -> float | None:
    """Peak signal-to-noise ratio after the removal of both means, for images reconstructed from differences.

    estimate, truth: of one shape. Returns float or None: as in `psnr_db`, of peak 1.
    """
    return psnr_db(estimate - np.mean(estimate), truth - np.mean(truth))
