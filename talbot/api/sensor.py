"""A sensor: its parameters by name, and frames through its Verilog and its golden model."""

import inspect
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any, Self, TypedDict, Unpack

import numpy.typing as npt

from talbot.api.light_field import LightField
from talbot.api.run import Run
from talbot.base.files import check_file, write
from talbot.base.progress import Steps, line
from talbot.imaging.frame import job
from talbot.imaging.frame.chip_picture import chip_svg
from talbot.imaging.frame.request import CONVERTERS, FrameRequest, light_field_of, request
from talbot.imaging.sequence.job import results as sequence_results
from talbot.models.parameters import (
    STANDARD,
    AmpTiming,
    ConverterParameters,
    FrameParameters,
    ParameterError,
    PixelType,
    SensorParameters,
    TileParameters,
    Window,
    check_choice,
    check_int,
    read_sensor,
    sensor_of,
    sensor_text,
)
from talbot.models.parameters.sensor_file import keys, nearest
from talbot.models.scene import Sampling, open_clip
from talbot.models.scene import scenes as named_scenes
from talbot.pixels.designs import IDEAL
from talbot.pixels.tabled import pixel_of, tabled, untabled

scenes = tuple(named_scenes)

Rows = Sequence[Sequence[PixelType]]
Seen = str | Path | LightField | npt.NDArray[Any]


class Settings(TypedDict, total=False):
    """See `Sensor.simulate`."""

    seed: int
    noise: float
    views: int | None
    depth: str | Path | None
    types: int | Iterable[int]
    window: tuple[int, int, int, int] | None
    decimation: int
    threshold: int
    phase: bool
    noise_floor: int
    lux: float
    light: str | None
    reflectance: str
    irradiance: float | None
    exposure: int | None
    timing: Mapping[str, int]
    overlap: bool
    test_pattern: bool
    frame_number: int


OBJECTS = "tile", "converter"  # given whole: some of their fields have the names of others
NAMES = {
    name.rpartition(".")[2]: name
    for name in keys()
    if name.partition(".")[0] not in OBJECTS and name not in ("array", "optics", "optics.camera", "electrical", "chip")
}


@dataclass(frozen=True, init=False, repr=False)
class Sensor:
    """A sensor of angle-sensitive pixels, by default the thesis's: 384 x 384 pixels in tiles of 4 x 6, f/1.2, 8 lanes.

    Sensor(rows=64, cols=96, m=0.5): any parameter by its name. `print(talbot.Sensor().text)` shows all, each with its
    meaning, unit and range: of the array (rows, cols, pitch), optics (m, aperture_sigma, ...), the camera (f_number,
    focal_length, focus, scale, exit_pupil), the photodiodes (white_current, full_well, ...) and the chip (lanes,
    divider, f_clk, ...).

    tile: rows of PixelType, 1..4 of 1..6 each, [[a, b], [c, d]]; or TileParameters. A PixelType has beta, gamma_deg,
    alpha, optionally m, or response=f: a function of the incidence angles theta_x and theta_y, arrays (n,)
    in rad, that gives the response of both diodes, (2, n), 0 or more.
    converter: 'circuit' (as ngspice has it), 'ideal', or a dict of inl, dnl, offset, noise, ktc (LSB),
    unit_mismatch (relative) and seed.
    pixel: 'ideal' (Eq. 3.1), 'sky130' or 'ihp-sg13g2': what the process's gratings do, as `make sim PIXEL=sky130`, or
    the path of a response.npz; types with a response keep it, except with a file. Tables are computed once, in half a
    minute.

    Raises ParameterError for an unknown name or a value out of range.
    """

    parameters: SensorParameters
    sized: bool = field(default=True, compare=False)  # rows or cols are given: not a light field's

    def __init__(
        self,
        *,
        tile: TileParameters | Rows | None = None,
        converter: str | Mapping[str, float] | ConverterParameters | None = None,
        pixel: str | None = None,
        **parameters: Any,
    ) -> None:
        object.__setattr__(self, "parameters", _changed(STANDARD, tile, converter, pixel, parameters))
        object.__setattr__(self, "sized", bool({"rows", "cols"} & parameters.keys()))

    @classmethod
    def of(cls, parameters: SensorParameters) -> Self:
        """Return the sensor of these parameters."""
        sensor = cls.__new__(cls)
        object.__setattr__(sensor, "parameters", parameters)
        return sensor

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Return the sensor in a file, sensor.toml. Raises ParameterError."""
        return cls.of(read_sensor(path))

    def save(self, path: str | Path) -> None:
        """Write it as a file for `load` and `make sim SENSOR=file`. Raises ParameterError, OSError."""
        check_file("path", Path(path))
        write(path, self.text)

    @property
    def text(self) -> str:
        """All parameters as TOML. Raises ParameterError where a pixel type has a function for a response."""
        return sensor_text(self.parameters)

    def replace(
        self,
        *,
        tile: TileParameters | Rows | None = None,
        converter: str | Mapping[str, float] | ConverterParameters | None = None,
        pixel: str | None = None,
        **parameters: Any,
    ) -> "Sensor":
        """This sensor with other values of some parameters. Raises ParameterError."""
        sensor = Sensor.of(_changed(self.parameters, tile, converter, pixel, parameters))
        object.__setattr__(sensor, "sized", self.sized or bool({"rows", "cols"} & parameters.keys()))
        return sensor

    def simulate(self, scene: Seen = "motorcycle", mode: str = "edge", **settings: Unpack[Settings]) -> Run:
        """One frame through the chip's Verilog, as `make sim` does it, and through the golden model.

        The simulator is compiled for each size of array and tile, then kept.

        scene: one of `talbot.scenes`, an image, a light field's file or folder, or a light field or its array, whose
        size that a sensor without rows and cols takes.
        mode: edge (differences), image (sums), raw (both diodes) or tof (four taps). settings:

        seed: of every random draw, 0..2**32-1 (1). noise: times the physical noise, 0..100 (1).
        views: of the capture along the pupil's diameter, 1..31, or None for as many as it needs. depth: file of an
        image's depth.
        types: numbers of the pixel types to read, or a mask of them (all). window: tiles to read, (row0, row1, col0,
        col1), both ends included (all). decimation: log2 of the tile step, 0..3 (0).
        threshold: in edge mode, |code| below it is left out, 0..127 (10). phase: in tof mode, phase and amplitude from
        the chip's divider (False); noise_floor: amplitude below which a phase is not valid, 0..255 (0).
        lux: illuminance of white, 0.001..1e6 (500); time of flight has another light, white_current.
        light: its spectrum, 'd65', 'a', 'led', 'e' or 'laser:650' (None: one wavelength, that of the pixels).
        reflectance: of all surfaces, 'gray', 'red', 'green' or 'blue'. irradiance: of white in W/m2, 1e-6..1e4,
        instead of lux.
        exposure: rows by which the reset pointer leads, 0..1023, or None for as many as that light asks for.
        timing: cycles of the amplifier's phases, {'t_int': 512, ...}: t_reset, t_int, t_cm, t_settle, t_read, t_guard,
        1..65535, and n_cm, common-mode resets, 0..255; with t_int given, an exposure of None is 0 rows.
        overlap: integrate a row while another converts (True).
        test_pattern: digital, instead of the pixels (False). frame_number: 0..65535 (0).

        Raises ParameterError, and ToolError where the simulator cannot be made.
        """
        with Steps(job.STEPS[:-1]) as steps:
            return Run(job.simulate_frame(self._request(scene, mode, settings), steps.note))

    def golden(self, scene: Seen = "motorcycle", mode: str = "edge", **settings: Unpack[Settings]) -> Run:
        """Return the frame of `simulate` by the golden model alone: the same bytes, no cycles, no energy."""
        with Steps(job.STEPS[:-1]) as steps:
            return Run(job.golden_result(self._request(scene, mode, settings), steps.note))

    def sequence(
        self, frames: str | Path | Iterable[npt.ArrayLike], mode: str = "edge", **settings: Unpack[Settings]
    ) -> Iterator[Run]:
        """Frames one after another through one running simulation: the chip keeps registers and state between them.

            for run in sensor.sequence("clip.gif", threshold=8):
                show(run.samples)

        frames: a folder of pictures, an animated picture or a video (models/scene/README.md); or arrays (height, width)
        or (height, width, 3), any iterable of them: uint8 and uint16 are sRGB codes, floats linear radiance, 0..16.
        All have one size and stand on the plane of pictures without depth. Frames are read, and runs made, as they are
        asked for. mode and settings: as of `simulate`, without depth. Each frame has independent temporal noise, and
        the next frame_number.

        Raises ParameterError, ToolError.
        """
        if (depth := settings.get("depth")) is not None:
            raise ParameterError(f"depth = {str(depth)!r}: must be left out, a sequence has no depth file")
        frame_request = self._request("flat", mode, settings)
        clip = open_clip(frames, Sampling.of(self.parameters))
        frame_request = replace(frame_request, scene=clip.name)
        return (Run(shown.result) for shown in sequence_results(frame_request, clip, job.Clock()))

    def _request(self, scene: Seen, mode: str, settings: Settings) -> FrameRequest:
        known = Settings.__annotations__
        for name in settings.keys() - known.keys():
            raise ParameterError(f"{name} = {settings[name]!r}: must be a setting of a frame{nearest(name, known)}")
        options: dict[str, Any] = dict(settings)
        types, window, timing = (options.pop(name, None) for name in ("types", "window", "timing"))
        if types is not None:
            options["mask"] = types if isinstance(types, int) else _mask(types)
        if timing is not None:
            _check_names("timing", timing, [item.name for item in fields(AmpTiming) if item.name != "exposure"])
            options["timing"] = timing
        if window is not None:
            if len(window) != 4:
                raise ParameterError(f"window = {window!r}: must be (row0, row1, col0, col1) in tiles")
            cut = Window(*window)
            options["window"] = lambda full: cut
        if isinstance(scene, str | Path):
            seen = light_field_of(str(scene)) or str(scene)
        else:
            seen = (scene if isinstance(scene, LightField) else LightField(scene)).data
        if not isinstance(seen, str) and not self.sized:
            options["rows"], options["cols"] = seen.own_size()
        return request(sensor=self.parameters, scene=seen, mode=mode, **options)

    def __repr__(self) -> str:
        """Return the parameters that differ from the default, by name."""
        changed = {name: value for name, value in _values(self.parameters).items() if value != _values(STANDARD)[name]}
        whole = {name: getattr(untabled(self.parameters), name) for name in OBJECTS}
        changed |= {name: value for name, value in whole.items() if value != getattr(STANDARD, name)}
        if (pixel := pixel_of(self.parameters)) != IDEAL:
            changed["pixel"] = pixel
        return f"Sensor({', '.join(f'{name}={value!r}' for name, value in changed.items())})"

    def _repr_html_(self) -> str:
        return chip_svg(self.parameters, FrameParameters(self.parameters.full_window))


def _mask(types: Iterable[int]) -> int:
    mask = 0
    for kind in types:
        check_int("types", kind, 0, 23)
        mask |= 1 << int(kind)
    return mask


def _check_names(field: str, values: Mapping[str, Any], known: Sequence[str]) -> None:
    for name in values:
        if name not in known:
            raise ParameterError(f"{field} = {dict(values)!r}: {name} must be one of its keys{nearest(name, known)}")


def _values(parameters: SensorParameters) -> dict[str, Any]:
    """Return every parameter by name."""
    values = {}
    for name, path in NAMES.items():
        value: Any = parameters
        for step in path.split("."):
            value = getattr(value, step)
        values[name] = value
    return values


def _changed(
    base: SensorParameters,
    tile: TileParameters | Rows | None,
    converter: str | Mapping[str, float] | ConverterParameters | None,
    pixel: str | None,
    named: Mapping[str, Any],
) -> SensorParameters:
    """Return ``base`` with these fields replaced."""
    tables: dict[str, Any] = {}
    for name, value in named.items():
        if name not in NAMES:
            near = nearest(name, [*OBJECTS, "pixel", *NAMES])
            raise ParameterError(f"{name} = {value!r}: must be a parameter of a sensor{near}")
        *path, last = NAMES[name].split(".")
        inner = tables
        for step in path:
            inner = inner.setdefault(step, {})
        inner[last] = value
    if tile is not None:
        tables["tile"] = tile if isinstance(tile, TileParameters) else TileParameters.of_rows(tile)
    if isinstance(converter, str):
        check_choice("converter", converter, CONVERTERS)
        converter = CONVERTERS[converter]
    if converter is not None:
        tables["converter"] = converter
    return tabled(sensor_of(tables, untabled(base)), pixel_of(base) if pixel is None else pixel, line)


# A notebook completes the names and shows their defaults
Sensor.__signature__ = inspect.Signature(  # pyright: ignore[reportAttributeAccessIssue]
    [
        inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=value)
        for name, value in (_values(STANDARD) | {"tile": None, "converter": "circuit", "pixel": IDEAL}).items()
    ]
)
