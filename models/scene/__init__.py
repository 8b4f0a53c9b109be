"""Scenes: light fields l[v, u, y, x] with depth and polarization, by name or from image files."""

from .registry import load, scenes
from .sampling import Sampling
from .scene import RADIANCE_MAX, Scene

__all__ = ["RADIANCE_MAX", "Sampling", "Scene", "load", "scenes"]
