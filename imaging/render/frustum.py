"""The views of a thin lens as Mitsuba's off-axis frusta.

Metres are the scene's own. The world has x to the right, y up, z towards the camera, which is at the origin: the
projects's (x, y, z) is the world's (x, -y, -z). A view (dv, du) looks from the point of the entrance pupil that is du
steps to the right and dv steps down; all views see the same rectangle of the focal plane, where disparity is 0.
"""

from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.imaging.render.variant import mitsuba
from talbot.models.scene import Sampling

Floats = npt.NDArray[np.float64]


def step(sampling: Sampling) -> float:
    """Between two views on the entrance pupil, in m of the scene."""
    return sampling.camera.aperture * sampling.camera.scale / sampling.views


def focal(sampling: Sampling) -> float:
    """Focal length in px."""
    return sampling.camera.principal_distance / sampling.pitch


def perspective(sampling: Sampling, dv: float, du: float, film: dict[str, Any]) -> dict[str, Any]:
    """Mitsuba's camera of the view (dv, du), in steps from the middle one. film: its type and options."""
    mi = mitsuba()

    rows, cols = sampling.shape
    focus = sampling.camera.focus * sampling.camera.scale
    x, y = du * step(sampling), -dv * step(sampling)
    wide, high = (n / focal(sampling) * focus for n in (cols, rows))
    look = mi.ScalarTransform4f().look_at(origin=[x, y, 0], target=[x, y, -1], up=[0, 1, 0])
    return {
        "type": "perspective",
        "fov": float(np.rad2deg(2 * np.arctan(cols / 2 / focal(sampling)))),
        "fov_axis": "x",
        "near_clip": 1e-3,
        "far_clip": 1e3,
        "principal_point_offset_x": -x / wide,
        "principal_point_offset_y": y / high,
        "to_world": look,
        "sampler": {"type": "independent"},
        "film": {"width": cols, "height": rows, "rfilter": {"type": "box"}} | film,
    }


def rays(sampling: Sampling, dv: float, du: float) -> tuple[Floats, Floats]:
    """Origins and directions (3, rows * cols), in the world, of the rays through the middle of every pixel.

    The directions have a z of -1: the distance along one is the planar depth.
    """
    rows, cols = sampling.shape
    focus = sampling.camera.focus * sampling.camera.scale
    y, x = np.meshgrid(*((np.arange(n) - (n - 1) / 2) / focal(sampling) for n in (rows, cols)), indexing="ij")
    origin = np.array([du, -dv, 0.0])[:, None] * step(sampling) * np.ones((1, rows * cols))
    aim = np.stack([x.ravel(), -y.ravel(), -np.ones(rows * cols)])
    return origin, aim - origin / focus
