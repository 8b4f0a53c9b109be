"""Scenes: light fields l[v, u, y, x] with depth and polarization, by name or from image files."""

from talbot.models.scene.clip import Clip, open_clip
from talbot.models.scene.light_field import LightField
from talbot.models.scene.light_field_file import read_light_field, write_light_field
from talbot.models.scene.photograph import scene_of
from talbot.models.scene.registry import load, scenes
from talbot.models.scene.sampling import Sampling
from talbot.models.scene.scene import RADIANCE_MAX, Scene

__all__ = [
    "RADIANCE_MAX",
    "Clip",
    "LightField",
    "Sampling",
    "Scene",
    "load",
    "open_clip",
    "read_light_field",
    "scene_of",
    "scenes",
    "write_light_field",
]
