"""The parameters of one run, validated before anything is computed."""

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

from talbot.models import parameters
from talbot.models.parameters import (
    ALL_TYPES,
    STANDARD,
    TYPICAL_CONVERTER,
    CameraParameters,
    FrameParameters,
    ParameterError,
    SensorParameters,
    Window,
)
from talbot.models.scene import LightField

CONVERTERS = {"typical": TYPICAL_CONVERTER, "ideal": parameters.ConverterParameters()}
Cut = Callable[[Window], Window]  # of the full window


@dataclass(frozen=True)
class FrameRequest:
    """One run of the main job.

    scene: a name of models.scene.scenes, a file or folder (models/scene/README.md), or a light field.
    depth: a file, or None.
    views: of the capture along the pupil's diameter, 1..31, or None for as many as it needs.
    noise: 0..100, times the physical noise. seed: 0..2**32-1. waves: (first row, last row) or None.
    out: folder for the results, or None for build/sim/<scene>.
    """

    sensor: SensorParameters
    frame: FrameParameters
    scene: str | LightField = "motorcycle"
    depth: str | None = None
    noise: float = 1.0
    seed: int = 1
    views: int | None = None
    waves: tuple[int, int] | None = None
    out: Path | None = None

    def __post_init__(self) -> None:
        self.sensor.check_window(self.frame.window)
        parameters.check_real("noise", self.noise, 0, 100)
        parameters.check_int("seed", self.seed, 0, 2**32 - 1)
        if self.views is not None:
            parameters.check_int("views", self.views, 1, 31)
        if self.waves and self.waves[1] >= self.sensor.array.rows:
            first, last = self.waves
            raise ParameterError(f"waves = {first}:{last}: rows must be in 0..{self.sensor.array.rows - 1}")

    @property
    def name(self) -> str:
        """Name of the scene without folder and suffix."""
        return self.scene.name if isinstance(self.scene, LightField) else Path(self.scene).stem

    @property
    def folder(self) -> Path:
        """Folder for the results."""
        return Path(self.out) if self.out else Path("build/sim") / self.name


def request(
    rows: int | None = None,
    cols: int | None = None,
    lanes: int | None = None,
    camera: CameraParameters | None = None,
    converter: str | None = None,
    sensor: SensorParameters = STANDARD,
    window: Cut | None = None,
    mask: int = ALL_TYPES,
    **rest: Any,
) -> FrameRequest:
    """A FrameRequest for ``sensor``, or one that has these in place of its own: rows, cols, lanes, camera, converter.

    converter: typical or ideal.
    window: the window to read, from the full one (all of it).
    rest: fields of FrameRequest and FrameParameters. Raises ParameterError.
    """
    parameters.check_choice("converter", converter, (None, *CONVERTERS))
    sensor = SensorParameters(
        sensor.tile,
        _with(sensor.array, rows=rows, cols=cols),
        _with(sensor.optics, camera=camera),
        sensor.electrical,
        CONVERTERS[converter] if converter else sensor.converter,
        _with(sensor.chip, lanes=lanes),
    )
    full = sensor.full_window
    own = {field.name: rest.pop(field.name) for field in fields(FrameRequest) if field.name in rest}
    frame = FrameParameters(window=window(full) if window else full, mask=mask, **rest)
    return FrameRequest(sensor=sensor, frame=frame, **own)


def _with(part: Any, **values: Any) -> Any:
    """``part`` with those of ``values`` that are not None."""
    return replace(part, **{name: value for name, value in values.items() if value is not None})
