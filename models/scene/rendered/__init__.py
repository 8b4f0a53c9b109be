"""Scenes that Mitsuba 3 rendered, as files: no formula of this project made their light.

Each is made for one lens. Through another, or enlarged to more pixels than it has, it is a picture with disparity
alone: its depth and its echoes are another lens's.
"""

import json
from pathlib import Path
from typing import Any, NamedTuple

from talbot.models.parameters import LIFE_SIZE, CameraParameters
from talbot.models.scene.light_field import LightField
from talbot.models.scene.light_field_file import read_light_field
from talbot.models.scene.sampling import Sampling
from talbot.models.scene.scene import Scene

FOLDER = Path(__file__).parent
MANIFEST = "rendered.json"


class Rendered(NamedTuple):
    """The lens and size that a scene is rendered for.

    Attributes
    ----------
    size : int
        Rows and columns in px.
    camera : CameraParameters
        The lens.
    """

    size: int
    camera: CameraParameters


RENDERED = {
    "room": Rendered(96, LIFE_SIZE),
    "plant": Rendered(96, LIFE_SIZE),
    "fog": Rendered(96, LIFE_SIZE),
    "spheres": Rendered(128, CameraParameters()),
    "sheet": Rendered(96, CameraParameters()),
}


def manifest() -> dict[str, Any]:
    """Return each file's command and SHA-256, by name.

    Returns dict of dicts.
    """
    return json.loads((FOLDER / MANIFEST).read_text(encoding="utf-8"))


def rendered(name: str, sampling: Sampling) -> Scene:
    """Return a rendered scene.

    name: of `RENDERED`. sampling: array and camera; the views are the file's. Returns Scene: its middle, pixel for
    pixel, or enlarged.
    """
    field, (size, lens) = read_light_field(FOLDER / f"{name}.npz"), RENDERED[name]
    larger = max(sampling.shape) > size
    if not larger:
        field = field.cropped(*sampling.shape)
    if larger or sampling.camera != lens:
        field = LightField(field.values, field.disparity, field.name, field.stokes, specular=field.specular)
    return field.scene(sampling)
