"""Reconstruction of a scene's image from the chip's codes in edge mode, and its quality."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from talbot.models.afe import trim_gain
from talbot.models.parameters import AmpTiming, SensorParameters
from talbot.models.plan.codes import codes_per_unit
from talbot.models.reconstruct.edges import EdgeOperator, Solver, image_from_edges
from talbot.models.reconstruct.psnr import psnr_without_mean_db
from talbot.models.scene import Scene


@dataclass(frozen=True, eq=False)
class Rebuilt:
    """A reconstructed image.

    image: (rows, cols), relative radiance of mean 0.
    psnr_db: against the scene's centre view, means removed, peak 1 (white); None where equal.
    method: name in reports.
    """

    image: npt.NDArray[np.float64]
    psnr_db: float | None
    method: str


def rebuild(
    codes: npt.NDArray[np.integer],
    read: npt.NDArray[np.bool_],
    scene: Scene,
    sensor: SensorParameters,
    trim: npt.ArrayLike,
    timing: AmpTiming = AmpTiming(),
    solver: Solver = Solver(),
) -> Rebuilt:
    """Reconstruct an image from decoded edge codes.

    codes: (rows, cols), codes of a frame in edge mode. read: (rows, cols), pixels that are read. scene: source of the
    disparity and of the true image. sensor: the sensor. trim: (types,), register values of the pixel types. timing: of
    the frame. solver: settings. Returns image and PSNR; a scene in focus has no edges, and its image is 0 everywhere.
    """
    disparity = np.zeros(scene.shape) if scene.disparity is None else scene.disparity
    operator = EdgeOperator(sensor, disparity, trim_gain(trim), read)
    unit = codes_per_unit(sensor, timing)
    image = image_from_edges(np.where(read, codes, 0) / unit, operator, solver)
    return Rebuilt(image, psnr_without_mean_db(image, scene.image), "conjugate gradients, disparity known")
