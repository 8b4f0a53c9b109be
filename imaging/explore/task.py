"""A task: what a sensor is for, hence the error of a picture that it gives. Tasks of this project are in `tasks`.

A file of yours is a task, too. It has a dict SPACE (imaging/explore/space.py) and a function:

    from talbot.imaging.explore.task import golden

    SPACE = {"array.rows": [48, 96], "chip.lanes": [1, 4], "threshold": (2, 40)}

    def evaluate(point, fidelity, seed):
        frame = golden(point, fidelity, seed, "coins", mode="edge", threshold=point.settings["threshold"])
        image = frame.result.image
        return frame.outcome(error=abs(image - frame.truth.image).mean(), picture=image)

FIGURES names further figures of its outcomes, for objectives and budgets; THESIS has values of a sensor to show, too.
`evaluate` returns an `Outcome`; what it raises is reported, a ParameterError as a sensor that cannot be.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt
from skimage.transform import resize

from talbot.base.kept import afresh
from talbot.imaging.explore import costs
from talbot.imaging.explore.space import Point, Space, check_space, sized
from talbot.imaging.frame import job
from talbot.imaging.frame.request import FrameRequest, request
from talbot.imaging.frame.result import GoldenResult
from talbot.models.parameters import STANDARD, ParameterError, RoomParameters, SensorParameters
from talbot.models.scene import Sampling, Scene, load

Floats = npt.NDArray[np.floating]
GRID = 192  # columns of the grid on which pictures of all sensors are compared
FIGURES = "error", "energy_uj", "bytes", "area_mm2", "frames_per_s"  # of every task
LANES = [1, 2, 4, 8, 16]  # that tasks try
SIM = "threshold", "lux", "mode", "decimation"  # settings that `make sim` has under their names
MORE = ("frames_per_s", "range_m")  # that are better the larger they are


@dataclass(frozen=True)
class Fidelity:
    """How much of a task is computed: a ``part`` of rows and columns, and ``views`` of the capture (None: all)."""

    name: str
    part: float
    views: int | None


SMALL, FULL = Fidelity("small", 0.5, 5), Fidelity("full", 1.0, None)


@dataclass(frozen=True, eq=False)
class Outcome:
    """What a sensor is worth for a task. figures: error, energy_uj, bytes, frames_per_s, and others of the task.

    picture: what it gives, (height, width), any range; darkest and brightest are shown black and white.
    """

    figures: Mapping[str, float]
    picture: Floats


class Task(Protocol):
    """A task; its objects can be pickled. about: in a line. unit: of the error. space: all keys that it varies."""

    @property
    def name(self) -> str:
        """Of folders and titles."""
        ...

    @property
    def about(self) -> str:
        """The error, in a line."""
        ...

    @property
    def space(self) -> Space:
        """Every key that the task varies."""
        ...

    @property
    def base(self) -> SensorParameters:
        """The sensor of keys that are not varied."""
        ...

    @property
    def extra(self) -> Sequence[str]:
        """Names of figures beyond `FIGURES`."""
        ...

    @property
    def thesis(self) -> Mapping[str, Any]:
        """Values of the thesis's sensor, which is on the page as a point; empty without one."""
        ...

    def effective(self, values: Mapping[str, Any]) -> Mapping[str, Any]:
        """Values of a point without those of no effect."""
        ...

    def sensor(self, point: Point) -> SensorParameters:
        """The sensor of a point, its array of the size that the task gives it. Raises ParameterError."""
        ...

    def requests(self, point: Point) -> Sequence[FrameRequest]:
        """The frames that one result takes, for what is known before they are simulated. Raises ParameterError."""
        ...

    def evaluate(self, point: Point, fidelity: Fidelity, seed: int) -> Outcome:
        """Simulate by the golden chip. Raises ParameterError where there is no such sensor."""
        ...

    def free_error(self) -> float | None:
        """The error of what costs nothing, None where there is none."""
        ...

    def words(self, point: Point) -> str:
        """The command that simulates the point, without SENSOR=."""
        ...

    def content(self) -> Sequence[object]:
        """What decides results besides the code: names, numbers, paths of files (`base.cache.digest`)."""
        ...


@dataclass(frozen=True, eq=False)
class Frame:
    """One frame of a point by the golden chip. whole: the request for all of the array; result: of its part."""

    whole: FrameRequest
    result: GoldenResult
    fidelity: Fidelity = FULL

    @cached_property
    def truth(self) -> Scene:
        """The scene at the pixels of the result."""
        return self.result.exposed.scene

    @cached_property
    def reference(self) -> Scene:
        """The scene in the same field of view on the grid that all sensors of a task share."""
        return reference(self.result.request, self.fidelity)

    def outcome(self, error: float, picture: Floats, **more: float) -> Outcome:
        """The frame's costs with the ``error`` of a task. more: other figures."""
        return Outcome({"error": float(error)} | costs.measured([self.whole], [self.result]) | more, picture)


def framed(
    point: Point,
    seed: int,
    scene: str,
    mode: str,
    exposure: float = 1.0,
    lux: float = RoomParameters.illuminance,
    **settings: Any,
) -> FrameRequest:
    """The request of a frame of all of a point's array.

    exposure: part of the time that the light asks for, 0..1. settings: as of `imaging.frame.request.request`.
    """
    whole = request(sensor=point.sensor, scene=scene, mode=mode, lux=lux, seed=seed, **settings)
    lead = whole.frame.timing.exposure
    if exposure < 1 and lead:
        rows = round(exposure * lead)
        whole = request(sensor=point.sensor, scene=scene, mode=mode, lux=lux, seed=seed, exposure=rows, **settings)
    return whole


def middle(whole: FrameRequest, fidelity: Fidelity) -> FrameRequest:
    """``whole`` of what a fidelity computes: of the middle of the array, with the timing of all of it."""
    sensor = sized(whole.sensor, fidelity.part)
    frame = replace(whole.frame, window=sensor.full_window)
    return replace(whole, sensor=sensor, frame=frame, views=fidelity.views or whole.views)


def golden(point: Point, fidelity: Fidelity, seed: int, scene: str, mode: str = "edge", **settings: Any) -> Frame:
    """A frame by the golden chip. settings: as of `framed`. Raises ParameterError."""
    whole = framed(point, seed, scene, mode, **settings)
    return Frame(whole, read(middle(whole, fidelity)), fidelity)


def read(frame_request: FrameRequest) -> GoldenResult:
    """A frame by the golden chip; of what it computes the scene alone is kept."""
    scene, todo = job.see(frame_request)
    if scene.render is None:  # its light field has its own views
        frame_request = replace(frame_request, views=None)
    with afresh():
        return job.read_golden(frame_request, job.expose(frame_request, scene, todo))


def reference(frame_request: FrameRequest, fidelity: Fidelity = FULL) -> Scene:
    """The scene in the field of view of a request, on the grid that all sensors share.

    Its columns are the part of `GRID` that the ``fidelity`` computes.
    """
    sampling, array = Sampling.of(frame_request.sensor), frame_request.sensor.array
    cols = max(round(GRID * fidelity.part), 1)
    pitch = array.cols * array.pitch / cols
    rows = max(round(array.rows * array.pitch / pitch), 1)
    return _reference(frame_request.scene, frame_request.depth, replace(sampling, rows=rows, cols=cols, pitch=pitch))


@lru_cache(maxsize=8)
def _reference(scene: Any, depth: str | None, sampling: Sampling) -> Scene:
    return load(scene, sampling, depth)


def on_grid(values: Floats, shape: tuple[int, int]) -> Floats:
    """Pictures (..., rows, cols) at the size ``shape``: interpolated, or averaged where it is smaller."""
    values = np.asarray(values, float)
    if values.shape[-2:] == shape:
        return values
    flat = values.reshape(-1, *values.shape[-2:])
    size: Any = shape
    out: list[Any] = [resize(plane, size, order=1, mode="edge", anti_aliasing=plane.shape > shape) for plane in flat]
    return np.stack(out).reshape(*values.shape[:-2], *shape)


def rms(error: Floats) -> float:
    """Root of the mean square."""
    return float(np.sqrt(np.mean(np.square(np.abs(error)))))


@dataclass(frozen=True)
class OwnTask:
    """A task from a Python file: its text, so that workers on other machines have it, too. Raises ParameterError."""

    path: Path
    text: str
    base: SensorParameters = STANDARD

    def __post_init__(self) -> None:
        check_space(self.module.get("SPACE"), str(self.path))
        if not callable(self.module.get("evaluate")):
            raise ParameterError(f"task = {str(self.path)!r}: must have a function evaluate(point, fidelity, seed)")

    @property
    def module(self) -> dict[str, Any]:
        """The file's names."""
        return _module(str(self.path), self.text)

    @property
    def extra(self) -> Sequence[str]:
        """FIGURES of the file."""
        return tuple(self.module.get("FIGURES", ()))

    @property
    def thesis(self) -> Mapping[str, Any]:
        """THESIS of the file."""
        return self.module.get("THESIS", {})

    @property
    def name(self) -> str:
        """The file's name without .py."""
        return self.path.stem

    @property
    def about(self) -> str:
        """The first line of the file's docstring."""
        return (self.module.get("__doc__") or f"error of {self.path.name}").strip().splitlines()[0]

    @property
    def space(self) -> Space:
        """SPACE of the file."""
        return self.module["SPACE"]

    def effective(self, values: Mapping[str, Any]) -> Mapping[str, Any]:
        """All: what the file reads is not known."""
        return values

    def sensor(self, point: Point) -> SensorParameters:
        """The sensor of a point."""
        return point.sensor

    def requests(self, point: Point) -> Sequence[FrameRequest]:
        """None: what the file reads is not known before it has run."""
        return ()

    def evaluate(self, point: Point, fidelity: Fidelity, seed: int) -> Outcome:
        """What the file's function returns. Raises TypeError where that is no Outcome with an error."""
        outcome = self.module["evaluate"](point, fidelity, seed)
        if not isinstance(outcome, Outcome) or "error" not in outcome.figures:
            raise TypeError(f"evaluate of {self.path.name} returns {outcome!r}: must be an Outcome with an error")
        return outcome

    def free_error(self) -> float | None:
        """None."""
        return None

    def words(self, point: Point) -> str:
        """The frame's settings, as far as `make sim` has them; the file says what else it does."""
        return " ".join(
            ["make sim", *(f"{name.upper()}={value}" for name, value in point.settings.items() if name in SIM)]
        )

    def content(self) -> Sequence[object]:
        """Its text."""
        return (self.text,)


@lru_cache(maxsize=4)
def _module(path: str, text: str) -> dict[str, Any]:
    names: dict[str, Any] = {"__name__": "talbot_task", "__file__": path}
    try:
        exec(compile(text, path, "exec"), names)
    except Exception as error:  # whatever a file of the user's raises
        raise ParameterError(f"task = {path!r}: {type(error).__name__}: {error}") from None
    return names
