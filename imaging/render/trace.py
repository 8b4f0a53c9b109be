"""Worlds through Mitsuba: views, depth, Stokes parameters, direct light and transients, as arrays of a light field."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.imaging.render import variant
from talbot.imaging.render.frustum import perspective, rays
from talbot.imaging.render.variant import mitsuba
from talbot.imaging.render.worlds import GLOSSY, Objects, World, flash, mirror
from talbot.models.scene import Sampling, camera

Floats = npt.NDArray[np.float64]
Note = Callable[[str], None]
DEPTH, DEPTH_MEDIUM = 6, 24  # scatterings of a path at most
WHITE = 0.9  # the brightest 0.5 % of the middle view of modulated light
LUMINANCE = {"type": "hdrfilm", "pixel_format": "luminance", "component_format": "float32"}
STOKES = (1, 4, 7, 10)  # channels of S0..S3, behind the picture and each three times
MIDDLE = 16  # samples of the middle view's Stokes parameters, times those of a view: it is the truth of figures
TRANSIENT = 4  # samples of the transients, times those of a view
COARSE = 2  # px along each side of a transient
SHINE = 0.5  # of the brightest of the same surface: a mirror image that is brighter is a highlight
SAME = 1e-3  # m: surfaces at this distance are one


@dataclass(frozen=True)
class Tracer:
    """A world before the views of a sampling.

    samples: a pixel and view. seed: of the first view; each has its own. note: called with what is rendered next.
    """

    world: World
    sampling: Sampling
    samples: int = 256
    seed: int = 1
    threads: int = 1
    note: Note = lambda text: None

    def arrays(self) -> dict[str, Any]:
        """Arrays of an .npz of `talbot.LightField`. Raises ToolError without Mitsuba."""
        self.note("depth")
        variant.use(variant.PLAIN, self.threads)
        steps, lens = [float(s) for s in self.sampling.steps], self.sampling.camera
        depths = np.array([[self._depth(self._objects(), v, u) for u in steps] for v in steps])
        out: dict[str, Any] = {"disparity": camera.disparity(camera.scaled(depths, lens), self.sampling)}
        out["depth"] = depths[self._middle, self._middle]
        if self.world.hidden:
            rest = {name: item for name, item in self._objects().items() if not name.startswith(self.world.hidden)}
            out["behind"] = self._depth(rest)
        return out | (self._polarized() if self.world.stokes else self._flashed())

    @property
    def _middle(self) -> int:
        return self.sampling.views // 2

    def _objects(self) -> Objects:
        return self.world.objects(self.sampling)

    def _views(self, what: str) -> Iterator[tuple[int, int]]:
        for v, u in np.ndindex(self.sampling.views, self.sampling.views):
            self.note(f"{what}: view {v} {u}")
            yield v, u

    def _scene(self, objects: Objects) -> Any:
        return mitsuba().load_dict({"type": "scene"} | objects)

    def _seen(self, scene: Any, integrator: Objects, v: int, u: int, film: Objects = LUMINANCE, more: int = 1) -> Any:
        """Return the picture of a view, (rows, cols, channels). more: times the samples."""
        dv, du = self.sampling.steps[v], self.sampling.steps[u]
        sensor = mitsuba().load_dict(perspective(self.sampling, float(dv), float(du), film))
        seed = self.seed + v * self.sampling.views + u
        by = mitsuba().load_dict(integrator)
        asked: dict[str, Any] = {"sensor": sensor, "integrator": by, "spp": more * self.samples, "seed": seed}
        return mitsuba().render(scene, **asked)

    def _depth(self, objects: Objects, dv: float = 0.0, du: float = 0.0) -> Floats:
        """Return the planar depth at the middle of every pixel of a view, in m of the scene, (rows, cols)."""
        origin, aim = rays(self.sampling, dv, du)
        length = np.linalg.norm(aim, axis=0)
        ray = mitsuba().Ray3f(mitsuba().Point3f(*origin), mitsuba().Vector3f(*(aim / length)))
        scene = self._scene(objects)  # kept: rays are traced when their values are asked for
        return (np.array(scene.ray_intersect(ray).t, float) / length).reshape(self.sampling.shape)

    def _polarized(self) -> dict[str, Any]:
        """Light, S1 and S2 of every view, and where highlights are."""
        n, shape = self.sampling.views, self.sampling.shape
        out = {"specular": self._highlights()} if self.world.lamps else {}
        variant.use(variant.POLARIZED, self.threads)
        scene, stokes = self._scene(self._objects()), np.empty((4, n, n, *shape))
        integrator = {"type": "stokes", "nested": {"type": "path", "max_depth": DEPTH}}
        for v, u in self._views("Stokes parameters"):
            more = MIDDLE if v == u == self._middle else 1
            stokes[:, v, u] = np.moveaxis(np.array(self._seen(scene, integrator, v, u, more=more))[..., STOKES], -1, 0)
        return out | {"light_field": stokes[0], "s1": stokes[1], "s2": -stokes[2]}  # Mitsuba counts angles with y up

    def _highlights(self) -> npt.NDArray[np.bool_]:
        """Where the middle view shows a lamp's mirror image, brighter than SHINE of the brightest of its surface."""
        objects, out = self._objects(), np.zeros(self.sampling.shape, bool)
        nearest = self._depth(objects)
        lamps = {name: objects[name] for name in self.world.lamps}
        direct = {"type": "path", "max_depth": 2}
        for name in [name for name, item in objects.items() if item.get("bsdf", {}).get("type") in GLOSSY]:
            alone = self._scene(lamps | {name: mirror(objects[name])})
            light = np.array(self._seen(alone, direct, self._middle, self._middle))[..., 0]
            light *= np.abs(self._depth({name: objects[name]}) - nearest) < SAME
            out |= light > SHINE * light.max()
        return out

    def _flashed(self) -> dict[str, Any]:
        """Modulated light of every view, the share of it that comes straight, and the transients of the rest.

        Bins of the transients are of half the path: of the depth that a direct echo would have.
        """
        n, shape = self.sampling.views, self.sampling.shape
        medium = {} if self.world.medium is None else self.world.medium()
        clear, whole = self._scene(self._objects() | flash()), self._scene(self._objects() | flash() | medium)
        depth = DEPTH_MEDIUM if medium else DEPTH
        direct, every = {"type": "path", "max_depth": 2}, {"type": "volpath" if medium else "path", "max_depth": depth}
        total, straight = np.empty((2, n, n, *shape))
        for v, u in self._views("modulated light"):
            total[v, u] = np.array(self._seen(whole, every, v, u))[..., 0]
            straight[v, u] = np.array(self._seen(clear, direct, v, u))[..., 0] * self.world.passed
        self.note("transients")
        variant.use_transients(self.threads)
        first, last, width = self.world.bins
        bins = round((last - first) / width)
        film = {"type": "transient_hdr_film", "temporal_bins": bins, "bin_width_opl": 2 * width, "start_opl": 2 * first}
        clear, whole = self._scene(self._objects() | flash()), self._scene(self._objects() | flash() | medium)

        def _late(scene: Any, kind: str, most: int) -> Floats:
            by = {"type": kind, "camera_unwarp": False, "max_depth": most, "temporal_filter": "box"}
            found = self._seen(scene, by, self._middle, self._middle, film, TRANSIENT)[1]
            return np.array(found, float)[..., 0].reshape(shape[0] // COARSE, COARSE, -1, COARSE, bins).sum((1, 3))

        late = _late(whole, "transient_prbvolpath" if medium else "transient_path", depth)
        late = np.maximum(late - _late(clear, "transient_path", 2) * self.world.passed, 0)
        return {
            "light_field": total * (WHITE / np.quantile(total[self._middle, self._middle], 0.995)),
            "direct": np.clip(straight / np.maximum(total, 1e-12), 0, 1),
            "late": late / np.maximum(late.sum(-1, keepdims=True), 1e-12),
            "bins": np.array([first + width / 2, width]),
        }
