"""Scenes: light fields l[v, u, y, x] with depth and polarization, by name or from image files."""

from .registry import load, scenes
from .scene import RADIANCE_MAX, Sampling, Scene

__all__ = ["RADIANCE_MAX", "Sampling", "Scene", "load", "scenes"]
