"""Scenes by name."""

from functools import partial
from pathlib import Path

from models.parameters import ParameterError

from . import targets
from .motorcycle import motorcycle
from .photograph import PHOTOGRAPHS, photograph, picture

# Each is a function of a Sampling; `name:number` on the command line adds the number (edge:30 is 30 degrees).
scenes = {
    "motorcycle": motorcycle,
    "tilted": targets.tilted,
    "point": targets.point,
    "edge": targets.edge,
    "flat": targets.flat,
    "saturated": targets.saturated,
    "black": targets.black,
    "polarized": targets.polarized,
    **{name: partial(photograph, name) for name in PHOTOGRAPHS},
}
NUMBERS = {"edge": ("degrees", -360.0, 360.0), "flat": ("percent", 0.0, 1600.0), "polarized": ("percent", 0.0, 100.0)}


def load(scene, sampling, depth=None):
    """The Scene of a name in `scenes` (or `name:number`), else of an image file.

    scene: str. sampling: a Sampling. depth: a file for an image file, else None. Raises ParameterError.
    """
    name, colon, number = scene.partition(":")
    if scene not in scenes and not (colon and name in NUMBERS):
        return picture(scene, sampling, depth) if _looks_like_file(scene) else _unknown(scene)
    if depth is not None:
        raise ParameterError(f"depth = {str(depth)!r}: must be left out, the scene {name!r} has its own")
    if not colon:
        return scenes[name](sampling)
    return scenes[name](sampling, _number(name, number))


def _looks_like_file(scene):
    return any(c in scene for c in "./\\") or Path(scene).is_file()


def _unknown(scene):
    raise ParameterError(f"scene = {scene!r}: must be an image file or one of {', '.join(scenes)}")


def _number(name, text):
    what, low, high = NUMBERS[name]
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not low <= value <= high:
        raise ParameterError(f"scene {name} {what} = {text!r}: must be a number in [{low:g}, {high:g}]")
    return value
