"""The image of a scene from the codes that left the chip in edge mode, and how good it is."""

from dataclasses import dataclass

import numpy as np

from models.afe import trim_gain
from models.parameters import AmpTiming
from models.plan.flat import codes_per_unit

from .edges import EdgeOperator, Solver, image_from_edges
from .psnr import psnr_without_mean_db


@dataclass(frozen=True, eq=False)
class Rebuilt:
    """image: relative radiance of mean 0, (rows, cols). psnr_db: against the scene's centre view, means removed, peak 1
    (white); None where equal. method: for people."""

    image: np.ndarray
    psnr_db: float | None
    method: str


def rebuild(codes, read, scene, sensor, trim, timing=AmpTiming(), solver=Solver()):
    """Rebuilt of decoded edge codes (rows, cols).

    read: bool (rows, cols), pixels that were read. scene: the Scene, for its disparity and to compare with.
    trim: register values of the pixel types. timing: AmpTiming of the frame.
    A scene in focus makes no edges: then the image is 0 everywhere.
    """
    disparity = np.zeros(scene.shape) if scene.disparity is None else scene.disparity
    operator = EdgeOperator(sensor, disparity, trim_gain(trim), read)
    unit = codes_per_unit(sensor, timing)
    image = image_from_edges(np.where(read, codes, 0) / unit, operator, solver)
    return Rebuilt(image, psnr_without_mean_db(image, scene.image), "conjugate gradients, disparity known")
