"""Scenes by name."""

from collections.abc import Callable
from functools import partial
from pathlib import Path

from talbot.models.parameters import ParameterError
from talbot.models.scene import polarized, solids, targets
from talbot.models.scene.leaves import leaves
from talbot.models.scene.light_field import LightField
from talbot.models.scene.light_field_file import named
from talbot.models.scene.motorcycle import motorcycle
from talbot.models.scene.photograph import PHOTOGRAPHS, photograph, picture
from talbot.models.scene.rendered import RENDERED, rendered
from talbot.models.scene.sampling import Sampling
from talbot.models.scene.scene import Scene
from talbot.models.scene.video_file import VIDEOS

# Each is a function of a Sampling; `name:number` on the command line adds the number (edge:30 is 30 degrees).
scenes: dict[str, Callable[..., Scene]] = {
    "motorcycle": motorcycle,
    "moving": targets.moving,
    "tilted": targets.tilted,
    "point": targets.point,
    "edge": targets.edge,
    "flat": targets.flat,
    "saturated": targets.saturated,
    "black": targets.black,
    "polarized": polarized.polarized,
    "stress": polarized.stress,
    "specular": polarized.specular,
    "cornell": solids.cornell,
    "fence": solids.fence,
    "leaves": leaves,
    **{name: partial(rendered, name) for name in RENDERED},
    **{name: partial(photograph, name) for name in PHOTOGRAPHS},
}
NUMBERS = {
    "edge": ("degrees", -360.0, 360.0),
    "flat": ("percent", 0.0, 1600.0),
    "leaves": ("seed", 0.0, 1e9),
    "moving": ("px/s", 0.0, 1e6),
    "polarized": ("percent", 0.0, 100.0),
    "stress": ("degrees", -360.0, 360.0),
}


def load(scene: str | LightField, sampling: Sampling, depth: str | Path | None = None) -> Scene:
    """Load a scene by name, or from an image file, or the files of a light field.

    scene: str or LightField, a name in `scenes`, `name:number`, a path (models/scene/README.md), or the light field
    itself. sampling: array, views and camera. depth: depth file of an image file. Returns Scene: the scene. Raises
    ParameterError for an unknown name, a number out of range, or a file that cannot be read.
    """
    if isinstance(scene, str) and scene not in scenes and (read := named(scene)):
        return load(read(), sampling, depth)
    if isinstance(scene, LightField):
        if depth is not None:
            raise ParameterError(f"depth = {str(depth)!r}: must be left out, a light field has no depth file")
        return scene.scene(sampling)
    name, colon, number = scene.partition(":")
    if scene not in scenes and not (colon and name in NUMBERS):
        if Path(scene).suffix.lower() in VIDEOS and Path(scene).is_file():
            raise ParameterError(f"scene = {scene!r}: must be one picture, not a video; talbot sequence takes it")
        if _looks_like_file(scene):
            return picture(scene, sampling, depth)
        raise ParameterError(f"scene = {scene!r}: must be an image file or one of {', '.join(scenes)}")
    if depth is not None:
        raise ParameterError(f"depth = {str(depth)!r}: must be left out, the scene {name!r} has its own")
    if not colon:
        return scenes[name](sampling)
    return scenes[name](sampling, _number(name, number))


def _looks_like_file(scene: str) -> bool:
    return any(c in scene for c in "./\\") or Path(scene).is_file()


def _number(name: str, text: str) -> float:
    what, low, high = NUMBERS[name]
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not low <= value <= high:
        raise ParameterError(f"scene {name} {what} = {text!r}: must be a number in [{low:g}, {high:g}]")
    return value
