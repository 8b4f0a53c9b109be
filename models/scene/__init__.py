"""Scenes: light fields l[v, u, y, x] with depth and polarization, by name or from image files."""

from .light_field import LightField
from .light_field_file import read_light_field, write_light_field
from .registry import load, scenes
from .sampling import Sampling
from .scene import RADIANCE_MAX, Scene

__all__ = ["RADIANCE_MAX", "LightField", "Sampling", "Scene", "load", "read_light_field", "scenes", "write_light_field"]
