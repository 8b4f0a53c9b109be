"""Rendered scenes: Mitsuba's objects, in metres of the scene, and their lens."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from talbot.imaging.render.frustum import focal
from talbot.imaging.render.variant import mitsuba
from talbot.models.scene import Sampling, polarized
from talbot.models.scene.camera import PLANE

Objects = dict[str, Any]
SEED = 18  # of the textures and the leaves
LAMP = 7.5  # radiance of the lamps of `spheres`, white = 1
GLOSSY = ("pplastic",)  # of whose highlights polarization tells: a metal's have little
FOG = 0.9, 1.4  # m, of the scatterer
DENSITY, ALBEDO = 0.7, 0.95  # 1/m, extinction and what is scattered of it
LEAVES = 40  # of `plant`


@dataclass(frozen=True)
class World:
    """A scene to render.

    objects: what there is, of a Sampling. stokes: the Stokes parameters of every view are wanted; else there is a
    modulated lamp in the lens, and its transients are.
    hidden: objects that stand before others, of which the depth is wanted, too. medium: objects of a scatterer.
    lamps: objects whose mirror images are the highlights. passed: of the light, there and back, by the medium.
    bins: of the transients, in m of depth: first, last and width.
    """

    objects: Callable[[Sampling], Objects]
    stokes: bool = False
    hidden: tuple[str, ...] = ()
    medium: Callable[[], Objects] | None = None
    lamps: tuple[str, ...] = ()
    passed: float = 1.0
    bins: tuple[float, float, float] = (0.6, 9.6, 0.06)


def _at(x: float, y: float, z: float) -> Any:
    """Return a move to x to the right, y down, z m from the camera."""
    mi = mitsuba()

    return mi.ScalarTransform4f().translate([x, -y, -z])


def _turned(axis: tuple[float, float, float], degrees: float) -> Any:
    mi = mitsuba()

    return mi.ScalarTransform4f().rotate(list(axis), degrees)


def _scaled(*sizes: float) -> Any:
    mi = mitsuba()

    return mi.ScalarTransform4f().scale(list(sizes))


def _diffuse(level: float | np.ndarray[Any, Any], scale: float = 1.0) -> Objects:
    """Return a matt surface, of a reflectance or a texture (rows, cols), which repeats ``scale`` times."""
    mi = mitsuba()

    if isinstance(level, float):
        return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": {"type": "uniform", "value": level}}}
    picture = mi.Bitmap(np.asarray(level, np.float32)[..., None])
    texture = {"type": "bitmap", "bitmap": picture, "raw": True, "to_uv": _scaled(scale, scale, 1)}
    return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": texture}}


def _cloth(level: float, seed: int, contrast: float = 0.35) -> np.ndarray[Any, Any]:
    """Return a texture of waves of several lengths and directions that repeats, (256, 256), around a level."""
    rng = np.random.default_rng((SEED, seed))
    y, x = np.mgrid[:256, :256] / 256
    waves = np.zeros((256, 256))
    for _ in range(12):
        a, b = rng.integers(-6, 7, 2)
        waves += np.sin(2 * np.pi * (a * x + b * y + rng.random())) / np.sqrt(6)
    return np.clip(level * (1 + contrast * waves), 0.02, 0.98)


def room(sampling: Sampling) -> Objects:
    """Cornell box of a room's size, of which a long lens sees slanted blocks before the rear wall.

    What the walls next to the picture scatter reaches everything in it.
    """
    f = focal(sampling)
    half = sampling.cols / 2 / f
    walls = {
        "rear": _at(0, 0, 4.6) @ _turned((0, 1, 0), 30) @ _scaled(0.3, 0.3, 1),
        "left": _at(-0.7, 0, 3.0) @ _turned((0, 1, 0), 90) @ _scaled(2.5, 0.7, 1),
        "right": _at(0.7, 0, 3.0) @ _turned((0, 1, 0), -90) @ _scaled(2.5, 0.7, 1),
        "floor": _at(0, 0.7, 3.0) @ _turned((1, 0, 0), -90) @ _scaled(0.7, 2.5, 1),
        "ceiling": _at(0, -0.7, 3.0) @ _turned((1, 0, 0), 90) @ _scaled(0.7, 2.5, 1),
        "end": _at(0, 0, 5.0) @ _scaled(0.7, 0.7, 1),
    }
    out: Objects = {
        name: {"type": "rectangle", "to_world": move, "bsdf": _diffuse(0.7)} for name, move in walls.items()
    }
    out["rear"]["bsdf"] = _diffuse(_cloth(0.75, 1), 5.0)
    tall = _at(-0.45 * half * 3.3, 0.25 * half * 3.3, 3.3) @ _turned((0, 1, 0), 25) @ _turned((1, 0, 0), 15)
    short = _at(0.5 * half * 2.4, 0.6 * half * 2.4, 2.4) @ _turned((0, 1, 0), -30) @ _turned((1, 0, 0), 20)
    out["tall"] = {
        "type": "cube",
        "to_world": tall @ _scaled(0.45 * half * 3.3, 0.85 * half * 3.3, 0.06),
        "bsdf": _diffuse(_cloth(0.42, 2), 1.0),
    }
    out["short"] = {
        "type": "cube",
        "to_world": short @ _scaled(0.42 * half * 2.4, 0.42 * half * 2.4, 0.05),
        "bsdf": _diffuse(_cloth(0.25, 3), 1.0),
    }
    return out


def plant(sampling: Sampling) -> Objects:
    """Leaves in the focal plane before a slanted wall with a ball on it."""
    rng = np.random.default_rng(SEED)
    f, focus = focal(sampling), sampling.camera.focus * sampling.camera.scale
    half = sampling.cols / 2 / f * focus
    wall = _at(0, 0, 1.7 * focus) @ _turned((0, 1, 0), 55) @ _scaled(1.0, 1.0, 1)
    out: Objects = {
        "wall": {"type": "rectangle", "to_world": wall, "bsdf": _diffuse(_cloth(0.8, 4), 14.0)},
        "ball": {
            "type": "sphere",
            "center": [0.2 * half, -0.2 * half, -1.55 * focus],
            "radius": 0.9 * half,
            "bsdf": _diffuse(0.6),
        },
    }
    out["leaf"] = _diffuse(_cloth(0.22, 8, 0.25), 0.7) | {"id": "leaf"}
    for n in range(LEAVES):
        x, y = rng.uniform(-1.1, 1.1, 2) * half
        size, turn, lean = rng.uniform(0.13, 0.2) * half, rng.uniform(0, 180), rng.uniform(-25, 25)
        move = _at(x, y, focus * rng.uniform(0.985, 1.015)) @ _turned((0, 0, 1), turn) @ _turned((0, 1, 0), lean)
        out[f"leaf{n}"] = {
            "type": "disk",
            "to_world": move @ _scaled(1.4 * size, 0.8 * size, 1),
            "bsdf": {"type": "ref", "id": "leaf"},
        }
    return out


def fog(sampling: Sampling) -> Objects:
    """Blocks and a wall behind a scatterer."""
    half = sampling.cols / 2 / focal(sampling)
    wall = _at(0, 0, 3.5) @ _turned((0, 1, 0), 35) @ _scaled(0.4, 0.4, 1)
    ball = [-0.35 * half * 2.8, -0.2 * half * 2.8, -2.8]
    block = _at(0.5 * half * 2.5, 0.3 * half * 2.5, 2.5) @ _turned((0, 1, 0), -40) @ _turned((1, 0, 0), 20)
    return {
        "wall": {"type": "rectangle", "to_world": wall, "bsdf": _diffuse(_cloth(0.8, 5), 8.0)},
        "ball": {"type": "sphere", "center": ball, "radius": 0.45 * half * 2.8, "bsdf": _diffuse(0.6)},
        "block": {
            "type": "cube",
            "to_world": block @ _scaled(0.35 * half * 2.5, 0.45 * half * 2.5, 0.05),
            "bsdf": _diffuse(_cloth(0.45, 6), 1.0),
        },
    }


def scatterer() -> Objects:
    """Return the slab of `fog` that scatters, wider than the picture and the light need it."""
    near, far = FOG
    inner = {
        "type": "homogeneous",
        "albedo": {"type": "uniform", "value": ALBEDO},
        "sigma_t": DENSITY,
        "phase": {"type": "isotropic"},
    }
    move = _at(0, 0, (near + far) / 2) @ _scaled(1.5, 1.5, (far - near) / 2)
    return {"fog": {"type": "cube", "to_world": move, "bsdf": {"type": "null"}, "interior": inner}}


def spheres(sampling: Sampling) -> Objects:
    """Glossy dielectric balls and one of metal, lamps next to them, cloth, and a lit panel that fills its pixels."""
    half = sampling.cols / 2 / focal(sampling)

    def ball(x: float, y: float, z: float, radius: float, bsdf: Objects) -> Objects:
        return {
            "type": "sphere",
            "center": [x * half * z, -y * half * z, -z],
            "radius": radius * half * z,
            "bsdf": bsdf,
        }

    def glossy(level: float, alpha: float) -> Objects:
        return {
            "type": "pplastic",
            "alpha": alpha,
            "int_ior": 1.5,
            "diffuse_reflectance": {"type": "uniform", "value": level},
        }

    metal = {"type": "roughconductor", "alpha": 0.3, "eta": 3.5, "k": 2.7, "distribution": "ggx"}  # tungsten
    panel = _at(0.72 * half * PLANE, -0.72 * half * PLANE, PLANE - 0.02) @ _scaled(
        0.2 * half * PLANE, 0.16 * half * PLANE, 1
    )
    out: Objects = {
        "cloth": {
            "type": "rectangle",
            "to_world": _at(0, 0, PLANE) @ _scaled(0.6, 0.6, 1),
            "bsdf": _diffuse(_cloth(0.45, 7), 6.0),
        },
        "large": ball(-0.4, -0.35, 2.9, 0.42, glossy(0.35, 0.06)),
        "small": ball(0.35, 0.4, 2.5, 0.4, glossy(0.2, 0.06)),
        "metal": ball(-0.5, 0.62, 3.2, 0.26, metal),
        "panel": {
            "type": "rectangle",
            "to_world": panel,
            "bsdf": {"type": "diffuse", "reflectance": {"type": "uniform", "value": 0.0}},
            "emitter": _emitter(4.0),
        },
        "sky": {"type": "constant", "radiance": {"type": "uniform", "value": 0.3}},
    }
    return out | _lamps()


def mirror(item: Objects) -> Objects:
    """Return an object of a glossy material without what it scatters from below its surface."""
    dark = {"diffuse_reflectance": {"type": "uniform", "value": 0.0}} if item["bsdf"]["type"] == "pplastic" else {}
    return item | {"bsdf": item["bsdf"] | dark}


def flash() -> Objects:
    """Return the modulated light, in the middle of the lens."""
    return {"flash": {"type": "point", "position": [0.0, 0.0, 0.0], "intensity": {"type": "uniform", "value": 1.0}}}


def _emitter(radiance: float) -> Objects:
    return {"type": "area", "radiance": {"type": "uniform", "value": radiance}}


def _lamps() -> Objects:
    """Two lamps across the line of sight, so that their mirror images are near Brewster's angle."""
    mi = mitsuba()

    out: Objects = {}
    for name, place in (("left", (-1.6, 0.5, -2.4)), ("above", (0.7, 1.5, -2.3))):
        move = mi.ScalarTransform4f().look_at(origin=list(place), target=[0, 0, -2.9], up=[0.1, 0, 1])
        out[name] = {"type": "disk", "to_world": move @ _scaled(0.9, 0.9, 1), "emitter": _emitter(LAMP)}
    return out


def sheet(sampling: Sampling) -> Objects:
    """Stressed clear sheet with a hole, pulled along the rows, before a polarizer and a bright field.

    The retarder's axis and delay at every point are Kirsch's; Mueller matrices and geometry are Mitsuba's.
    """
    mi = mitsuba()

    half = sampling.cols / 2 / focal(sampling) * PLANE
    side = 1.25  # the sheet is wider than the picture
    n = 512
    y, x = np.mgrid[:n, :n] * (2 / (n - 1)) - 1
    delay, axis = polarized.kirsch(side * y, side * x, 2 * polarized.HOLE)
    maps = {
        "delta": mi.Bitmap(np.rad2deg(delay).astype(np.float32)[..., None]),
        "theta": mi.Bitmap(np.rad2deg(axis).astype(np.float32)[..., None]),  # rows of a texture go up
    }
    textures = {
        name: {"type": "bitmap", "bitmap": m, "raw": True, "filter_type": "nearest"} for name, m in maps.items()
    }
    upright = _scaled(side * half, side * half, 1)
    return {
        "sheet": {"type": "rectangle", "to_world": _at(0, 0, PLANE) @ upright, "bsdf": {"type": "retarder"} | textures},
        "polarizer": {
            "type": "rectangle",
            "to_world": _at(0, 0, PLANE + 0.05) @ upright,
            "bsdf": {"type": "polarizer", "theta": {"type": "uniform", "value": 30.0}},
        },
        "field": {"type": "rectangle", "to_world": _at(0, 0, PLANE + 0.1) @ _scaled(2, 2, 1), "emitter": _emitter(1.2)},
    }


WORLDS = {
    "room": World(room),
    "plant": World(plant, hidden=("leaf",)),
    "fog": World(fog, medium=scatterer, passed=float(np.exp(-2 * DENSITY * (FOG[1] - FOG[0])))),
    "spheres": World(spheres, stokes=True, lamps=("left", "above")),
    "sheet": World(sheet, stokes=True),
}
