"""The parameters of one run, validated before anything is computed."""

import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from functools import cache, cached_property
from pathlib import Path
from typing import Any

from talbot.base.paths import results_of
from talbot.base.progress import line
from talbot.imaging.frame.arguments import named
from talbot.imaging.simulate.frame import WAVES
from talbot.models import parameters
from talbot.models.calibrate import Calibration
from talbot.models.parameters import (
    ALL_TYPES,
    STANDARD,
    AmpTiming,
    CameraParameters,
    FrameParameters,
    ParameterError,
    RoomParameters,
    SensorParameters,
    Window,
)
from talbot.models.plan.exposure import exposed_for, fitting
from talbot.models.scene import LightField, light_field_file, scenes

CONVERTERS = {"circuit": parameters.circuit_converter(), "ideal": parameters.ConverterParameters()}
Cut = Callable[[Window], Window]  # of the full window


@dataclass(frozen=True)
class FrameRequest:
    """One run of the main job.

    scene: a name of models.scene.scenes, a file or folder (models/scene/README.md), or a light field.
    depth: a file, or None.
    views: of the capture along the pupil's diameter, 1..31, or None for as many as it needs.
    room: the light of all modes but time of flight, whose light is its source's alone (`lit`).
    noise: 0..100, times the physical noise. seed: 0..2**32-1. waves: (first row, last row) or None.
    waves_format: one of WAVES. out: folder for the results, or None for build/sim/<scene>.
    columns: curves of the column amplifiers, None for straight ones.
    """

    sensor: SensorParameters
    frame: FrameParameters
    scene: str | LightField = "motorcycle"
    depth: str | None = None
    room: RoomParameters = RoomParameters()
    noise: float = 1.0
    seed: int = 1
    views: int | None = None
    waves: tuple[int, int] | None = None
    waves_format: str = WAVES[0]
    out: Path | None = None
    calibration: Calibration | None = None
    columns: parameters.ColumnCurves | None = None

    def __post_init__(self) -> None:
        self.sensor.check_window(self.frame.window)
        if self.frame.phase and not self.sensor.chip.has_phase_path:
            raise ParameterError("phase = True: must be False, the sensor has no phase path (chip.divider = none)")
        if self.calibration is not None:
            self.calibration.applied(self.sensor)  # fits
        parameters.check_real("noise", self.noise, 0, 100)
        parameters.check_int("seed", self.seed, 0, 2**32 - 1)
        if self.views is not None:
            parameters.check_int("views", self.views, 1, 31)
        parameters.check_choice("waves_format", self.waves_format, WAVES)
        if self.waves_format != WAVES[0] and not self.waves:
            raise ParameterError(f"waves_format = {self.waves_format!r}: must be with waves")
        if self.waves and self.waves[1] >= self.sensor.array.rows:
            first, last = self.waves
            raise ParameterError(f"waves = {first}:{last}: rows must be in 0..{self.sensor.array.rows - 1}")

    @cached_property
    def lit(self) -> SensorParameters:
        """The sensor with the photocurrent of white in the light of the frame."""
        return self.sensor if self.frame.mode == "tof" else self.room.lit(self.sensor)

    @property
    def wavelengths(self) -> tuple[tuple[float, float], ...]:
        """Wavelengths of the light in m and their weights in the electrons; none of light without a spectrum."""
        if self.room.spectrum is None:
            return ()
        nodes, weights = self.sensor.spectral.electrons(self.room.spectrum, self.room.reflectance)
        return tuple(zip(nodes.tolist(), weights.tolist(), strict=True))

    @property
    def of_frame(self) -> "FrameRequest":
        """Fields that decide a frame of a loaded scene: kept results depend on no file."""
        return replace(self, scene=self.name, depth=None, waves=None, waves_format=WAVES[0], out=None)

    @property
    def name(self) -> str:
        """Name of the scene without folder and suffix."""
        return self.scene.name if isinstance(self.scene, LightField) else named(self.scene)

    @property
    def folder(self) -> Path:
        """Folder for the results."""
        return Path(self.out) if self.out else results_of("sim") / self.name


def request(
    rows: int | None = None,
    cols: int | None = None,
    lanes: int | None = None,
    camera: CameraParameters | None = None,
    converter: str | None = None,
    sensor: SensorParameters = STANDARD,
    lux: float = RoomParameters().illuminance,
    light: str | None = None,
    reflectance: str = "gray",
    irradiance: float | None = None,
    exposure: int | None = None,
    timing: Mapping[str, int] | None = None,
    window: Cut | None = None,
    mask: int = ALL_TYPES,
    **rest: Any,
) -> FrameRequest:
    """Return a FrameRequest for ``sensor``, with these fields replaced: rows, cols, lanes, camera, converter.

    converter: circuit or ideal. lux: illuminance of white. light: name of its spectrum (`parameters.light`), in which
    the pixels then respond, None for one wavelength. reflectance: name of the scene's surfaces. irradiance: of white in
    W/m^2, instead of lux. timing: phases that are not the default, fields of AmpTiming but exposure. exposure: rows by
    which the reset pointer leads, or None for as many as give the signal of RoomParameters. Where it leads, t_int is so
    long that no row waits for the converters; a t_int in timing stays as it is, and the pointer then leads by no row
    where exposure is None. In time of flight it never leads.
    window: the window to read, from the full one (all of it).
    rest: fields of FrameRequest and FrameParameters. Raises ParameterError.
    """
    parameters.check_choice("converter", converter, (None, *CONVERTERS))
    sensor = replace(
        sensor,
        array=_with(sensor.array, rows=rows, cols=cols),
        optics=_with(sensor.optics, camera=camera),
        converter=CONVERTERS[converter] if converter else sensor.converter,
        chip=_with(sensor.chip, lanes=lanes),
    )
    full = sensor.full_window
    options = {field.name: rest.pop(field.name) for field in fields(FrameRequest) if field.name in rest}
    phases = dict(timing or {})
    frame = FrameParameters(window=window(full) if window else full, mask=mask, timing=AmpTiming(**phases), **rest)
    lamp = parameters.light(light) if light is not None else None
    room = RoomParameters(illuminance=lux, spectrum=lamp, reflectance=reflectance, irradiance=irradiance)
    frame_request = FrameRequest(sensor=_in_light(sensor, room, frame.mode), frame=frame, room=room, **options)
    if isinstance(frame_request.scene, LightField):
        _tell_changes(frame_request.scene, sensor.array.rows, sensor.array.cols)
    return replace(frame_request, frame=replace(frame, timing=_timing(frame_request, exposure, "t_int" in phases)))


def _in_light(sensor: SensorParameters, room: RoomParameters, mode: str) -> SensorParameters:
    """Return the sensor as its pixels respond in the light of a frame. Raises ParameterError."""
    if room.spectrum is None:
        if sensor.spectral.filter_width and mode != "tof":
            width = sensor.spectral.filter_width
            raise ParameterError(f"spectral.filter_width = {width!r}: must be 0 without a light (light = d65)")
        return sensor
    if mode == "tof":
        raise ParameterError(
            f"light = {room.spectrum.name!r}: must be left out with mode = tof, which has its source's"
        )
    from talbot.pixels.lit import in_light  # it imports the solver

    return in_light(sensor, room.spectrum, room.reflectance, line)


def light_field_of(scene: str | LightField) -> LightField | None:
    """Return the light field that a scene is, read where it is a file's or folder's name; None for another scene.

    Raises ParameterError.
    """
    if isinstance(scene, LightField):
        return scene
    read = None if scene in scenes else light_field_file.named(scene)
    return read() if read else None


def _tell_changes(field: LightField, rows: int, cols: int) -> None:
    """Print which parts of a light field the sensor does not see unchanged."""
    (height, width), prefix = field.shape, f"talbot: light field {field.name}: "
    if (height, width) != (rows, cols):
        step = min(height / rows, width / cols)
        how = f"enlarged {1 / step:.3g} times" if step < 1 else f"reduced {step:.3g} times" if step > 1 else "cut"
        _tell(f"{prefix}{height} x {width} px {how} to the sensor's {rows} x {cols}")
    if field.grid != (field.views, field.views):
        _tell(f"{prefix}of {field.grid[0]} x {field.grid[1]} views the middle {field.views} x {field.views} are taken")


@cache
def _tell(text: str) -> None:
    """Print a line, once."""
    print(text, file=sys.stderr, flush=True)


def _timing(request: FrameRequest, exposure: int | None, typed: bool) -> AmpTiming:
    """Return the timing of ``asked`` with its exposure; typed: its t_int stays as it is."""
    frame, sensor = request.frame, request.lit
    if frame.mode == "tof":
        return replace(frame.timing, exposure=exposure or 0)
    if exposure is None and not typed:
        return exposed_for(request.room.signal, frame, sensor)
    timing = frame.timing if typed or not exposure else fitting(frame, sensor)
    return replace(timing, exposure=exposure or 0)


def _with(part: Any, **values: Any) -> Any:
    """``part`` with those of ``values`` that are not None."""
    return replace(part, **{name: value for name, value in values.items() if value is not None})
