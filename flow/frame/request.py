"""The parameters of one run, validated before anything is computed."""

from collections.abc import Callable
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from models import parameters
from models.parameters import (
    ALL_TYPES,
    TYPICAL_CONVERTER,
    CameraParameters,
    FrameParameters,
    ParameterError,
    SensorParameters,
    Window,
)

Cut = Callable[[Window], Window]  # of the full window


@dataclass(frozen=True)
class FrameRequest:
    """One run of the main job.

    scene: a name of models.scene.scenes or an image file. depth: a file, or None.
    views: of the capture along the pupil's diameter, 1..31, or None for as many as it needs.
    noise: 0..100, times the physical noise. seed: 0..2**32-1. waves: (first row, last row) or None.
    out: folder for the results, or None for build/sim/<scene>.
    """

    sensor: SensorParameters
    frame: FrameParameters
    scene: str = "motorcycle"
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
        return Path(self.scene).stem

    @property
    def folder(self) -> Path:
        """Folder for the results."""
        return Path(self.out) if self.out else Path("build/sim") / self.name


def request(
    rows: int = 384,
    cols: int = 384,
    lanes: int = 8,
    camera: CameraParameters = CameraParameters(),
    converter: str = "typical",
    window: Cut | None = None,
    mask: int = ALL_TYPES,
    **rest: Any,
) -> FrameRequest:
    """A FrameRequest for an array of ``rows`` x ``cols`` pixels behind ``camera``.

    converter: typical or ideal.
    window: the window to read, from the full one (all of it).
    rest: fields of FrameRequest and FrameParameters. Raises ParameterError.
    """
    array, chip = parameters.ArrayParameters(rows=rows, cols=cols), parameters.ChipParameters(lanes=lanes)
    ends = TYPICAL_CONVERTER if converter == "typical" else parameters.ConverterParameters()
    parameters.check_choice("converter", converter, ("typical", "ideal"))
    sensor = SensorParameters(array=array, chip=chip, converter=ends, optics=parameters.OpticsParameters(camera=camera))
    full = sensor.full_window
    own = {field.name: rest.pop(field.name) for field in fields(FrameRequest) if field.name in rest}
    frame = FrameParameters(window=window(full) if window else full, mask=mask, **rest)
    return FrameRequest(sensor=sensor, frame=frame, **own)
