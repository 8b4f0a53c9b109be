"""The tasks of this project: edges, light fields, polarization, depth, recognition; and those in files."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from talbot.base.kept import afresh
from talbot.imaging.depth.capture import TAPS, capture
from talbot.imaging.depth.command import AMBIENT, CONTRAST
from talbot.imaging.depth.measure import COARSE, FAINT, by_disparity
from talbot.imaging.explore import costs
from talbot.imaging.explore.recognition import Recognition
from talbot.imaging.explore.space import TILE, TILES, Point, Space, point_of
from talbot.imaging.explore.task import (
    FIGURES,
    LANES,
    Fidelity,
    Floats,
    Outcome,
    OwnTask,
    Task,
    framed,
    golden,
    middle,
    on_grid,
    reference,
    rms,
)
from talbot.imaging.frame.arguments import named
from talbot.imaging.frame.light_field import estimate, estimator_of, prior_of
from talbot.imaging.frame.request import FrameRequest
from talbot.imaging.polar.measure import estimated
from talbot.imaging.recognize import data
from talbot.models.capture import cells
from talbot.models.parameters import LIFE_SIZE, STANDARD, ParameterError, RoomParameters, SensorParameters, check_choice
from talbot.models.pixel.time_of_flight import SPEED_OF_LIGHT, demodulate
from talbot.models.reconstruct import white_sum
from talbot.models.reconstruct.depth_field import depth_field, unwrap

DISPARITIES = 11  # tried by the light field's estimator, as `make tradeoff` does
ROWS = [48, 64, 96, 128, 192, 256, 384]
EXPOSURE = (0.1, 1.0)  # part of the time that fills 80 % of a well


@dataclass(frozen=True)
class SceneTask(ABC):
    """A task on pictures of scenes. scenes: names or files; figures are means over them. lux: of white."""

    scenes: tuple[str, ...]
    lux: float = RoomParameters.illuminance
    base: SensorParameters = STANDARD

    name: ClassVar[str] = ""
    about: ClassVar[str] = ""
    mode: ClassVar[str] = "raw"
    extra: ClassVar[Sequence[str]] = ()
    thesis: ClassVar[Mapping[str, Any]] = {"array.rows": 384, TILE: TILES[-1], "chip.lanes": 8, "exposure": 1.0}

    def effective(self, values: Mapping[str, Any]) -> Mapping[str, Any]:
        """All."""
        return values

    def sensor(self, point: Point) -> SensorParameters:
        """The point's own."""
        return point.sensor

    def settings(self, point: Point) -> dict[str, Any]:
        """Settings of the point's frames."""
        return {"lux": self.lux} | dict(point.settings)

    def requests(self, point: Point) -> Sequence[FrameRequest]:
        """One frame."""
        return [framed(point, 1, self.scenes[0], self.mode, **self.settings(point))]

    def evaluate(self, point: Point, fidelity: Fidelity, seed: int) -> Outcome:
        """Means over the scenes; the picture is that of the first."""
        outcomes = [self.seen(point, fidelity, seed, scene) for scene in self.scenes]
        figures = {name: float(np.mean([o.figures[name] for o in outcomes])) for name in outcomes[0].figures}
        return Outcome(figures, outcomes[0].picture)

    @property
    @abstractmethod
    def space(self) -> Space:
        """Every key that the task varies."""

    @abstractmethod
    def seen(self, point: Point, fidelity: Fidelity, seed: int, scene: str) -> Outcome:
        """Of one scene."""

    @abstractmethod
    def free(self, frame_request: FrameRequest) -> float:
        """The error of what costs nothing for the scene of a request."""

    def free_error(self) -> float | None:
        """Mean over the scenes, of the base's field of view."""
        point = point_of(self.thesis, self.base)
        settings = self.settings(point)
        frames = [framed(point, 1, scene, self.mode, **settings) for scene in self.scenes]
        return float(np.mean([self.free(frame) for frame in frames]))

    def words(self, point: Point) -> str:
        """`make sim` with the point's settings."""
        whole = self.requests(point)[0]
        words = ["make sim", f"SCENE={self.scenes[0]}", f"MODE={self.mode}", f"LUX={self.lux:g}"]
        if self.mode == "edge":
            words.append(f"THRESHOLD={whole.frame.threshold}")
        auto = framed(point, 1, self.scenes[0], self.mode, **self.settings(point) | {"exposure": 1.0}).frame.timing
        lead = whole.frame.timing.exposure
        return " ".join(words if whole.frame.timing == auto else [*words, f"EXPOSURE={lead}"])

    def content(self) -> Sequence[object]:
        """The scenes, those in files by their content, and the light."""
        files = [Path(scene) for scene in self.scenes if Path(scene).exists()]
        return (self.name, *self.scenes, *files, self.lux)


class Edges(SceneTask):
    """The image that the chip's edges give back."""

    name = "edges"
    about = "RMS error of the image rebuilt from the edges, its mean left out; white is 1"
    mode = "edge"
    thesis: ClassVar[Mapping[str, Any]] = {
        **SceneTask.thesis,
        "optics.camera.f_number": 1.2,
        "electrical.difference_gain": 4.0,
        "threshold": 10,
    }

    @property
    def space(self) -> Space:
        """Array, tile, converters, lens, gain; threshold and exposure of the frame."""
        return {
            "array.rows": ROWS,
            TILE: list(TILES),
            "chip.lanes": LANES,
            "chip.f_clk": [5e6, 10e6],
            "optics.camera.f_number": [1.2, 1.7, 2.4, 3.4],
            "electrical.difference_gain": [1.0, 2.0, 4.0, 8.0],
            "threshold": (2, 40),
            "exposure": EXPOSURE,
        }

    def seen(self, point: Point, fidelity: Fidelity, seed: int, scene: str) -> Outcome:
        """One edge frame, and the image rebuilt from it with the scene's disparity."""
        frame = golden(point, fidelity, seed, scene, self.mode, **self.settings(point))
        truth = np.asarray(frame.reference.image, float)
        with afresh():
            image = on_grid(frame.result.image, truth.shape)
        return frame.outcome(rms(image - image.mean() - truth + truth.mean()), image)

    def free(self, frame_request: FrameRequest) -> float:
        """Flat gray."""
        return float(np.std(reference(frame_request).image))


class LightFields(SceneTask):
    """Views of the light field."""

    name = "lightfield"
    about = "RMS error of the views, read back by `mixture`; white is 1"

    @property
    def space(self) -> Space:
        """Pixels on a die of one size behind one lens, tile, converters, exposure."""
        return {
            "array.rows": ROWS[1:],
            TILE: list(TILES),
            "chip.lanes": LANES,
            "chip.f_clk": [5e6, 10e6],
            "exposure": EXPOSURE,
        }

    def seen(self, point: Point, fidelity: Fidelity, seed: int, scene: str) -> Outcome:
        """One raw frame."""
        frame = golden(point, fidelity, seed, scene, self.mode, **self.settings(point))
        field = estimate(frame.result, prior=prior_of(frame.result, disparities=DISPARITIES)).light_field
        truth = np.asarray(frame.reference.full_light_field, float)
        views = on_grid(field, truth.shape[-2:])
        use = cells(len(truth)).astype(bool)
        return frame.outcome(rms((views - truth)[use]), views[len(views) // 2, 0])

    def free(self, frame_request: FrameRequest) -> float:
        """The true middle view in all: a perfect camera without angles."""
        truth = np.asarray(reference(frame_request).full_light_field, float)
        half = len(truth) // 2
        return rms((truth - truth[half, half])[cells(len(truth)).astype(bool)])


class Polarization(SceneTask):
    """Angle and degree of linear polarization."""

    name = "polarization"
    about = "RMS error of the degree of polarization as a vector of twice its angle"

    @property
    def space(self) -> Space:
        """As of light fields; only tiles with four orientations tell the angle."""
        tiles = [text for text in TILES if text.endswith("/4")]
        return {"array.rows": ROWS[1:], TILE: tiles, "chip.lanes": LANES, "exposure": EXPOSURE}

    def seen(self, point: Point, fidelity: Fidelity, seed: int, scene: str) -> Outcome:
        """One raw frame; a pixel without confidence has no polarization."""
        frame = golden(point, fidelity, seed, scene, self.mode, **self.settings(point))
        polarization = estimated(frame.result, frame.result.decoded.samples.astype(float))[0]
        s1, s2 = frame.reference.seen_polarization
        degree = polarization.degree * (polarization.confidence > 0)
        parts = on_grid(
            np.stack([degree * np.cos(2 * polarization.psi), degree * np.sin(2 * polarization.psi)]), np.shape(s1)
        )
        error = np.hypot(parts[0] - s1, parts[1] - s2)
        return frame.outcome(rms(error), np.hypot(*parts))

    def free(self, frame_request: FrameRequest) -> float:
        """No polarization."""
        return rms(np.hypot(*reference(frame_request).seen_polarization))


class Depth(SceneTask):
    """Depth by time of flight."""

    name = "depth"
    about = "RMS error of the depth of every pixel, m"
    mode = "tof"
    extra: ClassVar[Sequence[str]] = ("light_uj", "range_m")
    thesis: ClassVar[Mapping[str, Any]] = {"array.rows": 384, "chip.lanes": 8, "method": "field"}

    @property
    def space(self) -> Space:
        """Array, converters, modulation, light; method: what is sent."""
        return {
            "array.rows": ROWS[:5],
            "chip.lanes": LANES,
            "electrical.f_mod": (10e6, 200e6),
            "electrical.white_current": [0.03e-9, 0.06e-9, 0.12e-9, 0.25e-9],
            "optics.camera.f_number": [1.2, 1.7, 2.4],
            "method": ["divider", "field"],
        }

    def settings(self, point: Point) -> dict[str, Any]:
        """None but whether the divider's phases are sent: the light is the source's."""
        return {"phase": point.settings["method"] == "divider"}

    def requests(self, point: Point) -> Sequence[FrameRequest]:
        """One frame of phases, or both diodes of each tap."""
        check_choice("method", point.settings["method"], ("divider", "field"))
        whole = framed(point, 1, self.scenes[0], self.mode, **self.settings(point))
        if whole.frame.phase:
            return [whole]
        return [replace(whole, frame=replace(whole.frame, mode="raw"))] * TAPS

    def seen(self, point: Point, fidelity: Fidelity, seed: int, scene: str) -> Outcome:
        """Of divider: the chip's phase, in the first turn. Of field: the depth field's, unwrapped by its disparity."""
        whole = [replace(frame, seed=seed, scene=scene) for frame in self.requests(point)]
        first = framed(point, seed, scene, self.mode)
        with afresh():
            frames = capture(middle(first, fidelity), golden=True)
        turn = SPEED_OF_LIGHT / (2 * point.sensor.electrical.f_mod)
        if whole[0].frame.phase and frames.phases:
            phase, strength = frames.phases.echo
            depth = np.where(strength < FAINT, np.nan, np.mod(phase / (2 * np.pi), 1) * turn)
            depth = np.where(np.isnan(depth), np.nanmedian(depth) if np.isfinite(depth).any() else turn / 2, depth)
            results = [frames.phases]
        else:
            depth, results = _unwrapped(frames, turn), list(frames.pairs)
        truth = np.asarray(reference(frames.sums.request, fidelity).depth, float)
        depth = on_grid(depth, truth.shape)
        figures = {"error": rms(depth - truth)} | costs.measured(whole, results)
        return Outcome(figures | {"light_uj": costs.light_uj(first), "range_m": turn}, depth)

    def free(self, frame_request: FrameRequest) -> float:
        """One depth for all."""
        return float(np.std(np.asarray(reference(frame_request).depth)))

    def words(self, point: Point) -> str:
        """`make depth`, which reads frames of both methods."""
        return f"make depth SCENE={self.scenes[0]}"


def _unwrapped(frames: Any, turn: float) -> Floats:
    """Depth of the depth field in m, as `make depth` leads with."""
    result = frames.sums
    prior, white = (
        prior_of(result, disparities=DISPARITIES, **COARSE),
        white_sum(result.request.lit, result.request.frame.exposing),
    )
    field = depth_field(estimator_of(result, prior), frames.diodes() / white)
    coarse, doubt = by_disparity(result, field, prior)
    phase, strength = demodulate(field.centre * white)
    return unwrap(np.where(strength < FAINT, np.nan, phase), coarse / turn, doubt / turn).turns * turn


SCENES = {"edges": "motorcycle", "lightfield": "motorcycle", "polarization": "specular", "depth": "cornell"}
SCENES |= {"recognition": "digits"}
KINDS: dict[str, type[SceneTask]] = {
    "edges": Edges,
    "lightfield": LightFields,
    "polarization": Polarization,
    "depth": Depth,
}


def task_of(
    text: str, scenes: str = "", lux: float = RoomParameters.illuminance, sensor: SensorParameters | None = None
) -> Task:
    """The task of a name, or of a file .py.

    scenes: names or files with commas between, '' for the task's own. sensor: of what is not varied, None for the
    standard. Raises ParameterError.
    """
    if text.endswith(".py"):
        path = Path(text)
        if not path.is_file():
            raise ParameterError(f"task = {text!r}: no such file")
        if scenes:
            raise ParameterError(f"scenes = {scenes!r}: must be left out, {path.name} names its own")
        return OwnTask(path, path.read_text(encoding="utf-8"), sensor or STANDARD)
    check_choice("task", text, (*SCENES, "own.py"))
    names = tuple(filter(None, (scenes or SCENES[text]).split(",")))
    if text == "recognition":
        if len(names) != 1:
            raise ParameterError(f"scenes = {scenes!r}: must be one set of pictures, as DATA of make recognize")
        data.load(names[0])
        recognition: Any = Recognition(names[0], sensor or STANDARD)  # constants of a class fit properties
        return recognition
    task: Any = KINDS[text](names, lux, sensor or (depth_sensor() if text == "depth" else STANDARD))
    for scene in names:
        named(scene)
    return task


def depth_sensor() -> SensorParameters:
    """The sensor of `make depth`, by which the keys that are not varied are set."""
    standard = STANDARD.electrical
    electrical = replace(standard, f_mod=100e6, contrast=CONTRAST, ambient_current=AMBIENT * standard.white_current)
    return replace(STANDARD, optics=replace(STANDARD.optics, camera=LIFE_SIZE), electrical=electrical)


def figures_of(task: Task) -> tuple[str, ...]:
    """Names of all figures of a task."""
    return (*FIGURES, *task.extra)
