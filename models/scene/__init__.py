"""Scenes: light fields l[v, u, y, x] with depth and polarization, by name or from image files."""

from .clip import Clip, open_clip
from .light_field import LightField
from .light_field_file import read_light_field, write_light_field
from .photograph import scene_of
from .registry import load, scenes
from .sampling import Sampling
from .scene import RADIANCE_MAX, Scene

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
