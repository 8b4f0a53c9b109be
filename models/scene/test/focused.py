"""A camera focused so that pictures without depth have a chosen disparity."""

from dataclasses import replace

from talbot.models.scene import Sampling, camera


def focused(sampling: Sampling, disparity: float) -> Sampling:
    """``sampling`` with a telecentric camera in which the plane of pictures has ``disparity`` px a view step."""
    plane = 1 / float(camera.scaled(camera.PLANE, sampling.camera))
    focus = 1 / (plane - disparity / camera.per_inverse_metre(sampling))
    return replace(sampling, camera=replace(sampling.camera, focus=focus))
