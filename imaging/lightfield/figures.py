"""Figures of an estimated light field and of a baseline that costs nothing."""

import numpy as np
import numpy.typing as npt
from skimage.metrics import structural_similarity

from talbot.models.reconstruct import psnr_db

Values = npt.NDArray[np.floating]
SSIM_WINDOW = 7  # px


def figures(
    estimate: Values, truth: Values, free: float | None, clear: npt.NDArray[np.bool_] | None = None
) -> dict[str, float | None]:
    """Return PSNR, SSIM (mean of the views), gain over the copied image and parallax of a light field.

    slope, correlation: of the difference of opposite outer views, horizontal and vertical, to the true one; None where
    the true views are equal. free: PSNR (dB) of the copied sum image, which the gain is against. clear: pixels that
    count in all but SSIM, (rows, cols); None is all.
    """
    if clear is not None and not clear.any():
        return dict.fromkeys(("psnr_db", "ssim", "gain_db", "slope", "correlation"))
    some = slice(None) if clear is None or clear.all() else clear
    psnr = psnr_db(estimate[..., some], truth[..., some])
    slope, correlation = parallax(estimate[..., some], truth[..., some])
    gain = None if psnr is None or free is None else psnr - free
    return {"psnr_db": psnr, "ssim": ssim(estimate, truth), "gain_db": gain, "slope": slope, "correlation": correlation}


def ssim(estimate: Values, truth: Values) -> float | None:
    """Structural similarity, mean of the views; None where a view is smaller than the window."""
    if min(truth.shape[2:]) < SSIM_WINDOW:
        return None
    pairs = (
        (np.asarray(estimate[v, u], float), np.asarray(truth[v, u], float)) for v, u in np.ndindex(truth.shape[:2])
    )
    return float(np.mean([structural_similarity(a, b, data_range=1.0) for a, b in pairs]))


def parallax(estimate: Values, truth: Values) -> tuple[float | None, float | None]:
    """Slope and correlation of the found difference of the outermost middle views to the true one."""
    middle = len(truth) // 2
    a, b = (
        np.stack([field[middle, -1] - field[middle, 0], field[-1, middle] - field[0, middle]]).astype(float)
        for field in (estimate, truth)
    )
    energy, true, shared = float((a * a).sum()), float((b * b).sum()), float((a * b).sum())
    if not true:
        return None, None
    return shared / true, shared / np.sqrt(energy * true) if energy else 0.0
