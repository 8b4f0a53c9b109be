"""The search space: keys of sensor.toml and settings of a frame, and the sensor that their values make.

A space is a dict, key to values: a list of choices, or a tuple (low, high), of whole numbers where both are. A key with
a dot is one of sensor.toml, but these mean more:

    tile.types     "betas/orientations": "12+24/2" has beta 12 and 24, orientations 0 and 90, alpha 0 and pi/2
    array.rows     the array is square and keeps its width: cols and pitch follow (where array.pitch varies, cols alone)
    array.pitch    the focal length follows the array's width, so that the field of view stays

Other keys are settings that the task reads: threshold, exposure (part of the time that the light asks for), ...
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import pi
from typing import Any

from talbot.base.arguments import real
from talbot.models.parameters import STANDARD, ParameterError, PixelType, SensorParameters, TileParameters, sensor_of
from talbot.models.parameters.sensor_file import keys, nearest

Space = Mapping[str, list[Any] | tuple[Any, Any]]
Values = Mapping[str, Any]
BETAS = (12.0, 18.0, 24.0)  # that `make pixel` reaches in SKY130's metals (docs/results/pixel.md)
ORIENTATIONS = (0.0, 90.0, 45.0, -45.0)
TILES = tuple(f"{betas}/{count}" for betas in ("12", "18", "24", "12+24", "12+18+24") for count in (2, 4))
SHAPES = {4: (2, 2), 8: (2, 4), 12: (3, 4), 16: (4, 4), 24: (4, 6)}  # types: rows and columns of the tile
TILE, ROWS, COLS, PITCH, FOCAL = "tile.types", "array.rows", "array.cols", "array.pitch", "optics.camera.focal_length"
RANGE = re.compile(r"(.+)\.\.(.+)")


@dataclass(frozen=True)
class Point:
    """A point of the space: its values, the sensor that they make, and the settings of its frames."""

    values: Values
    sensor: SensorParameters
    settings: Mapping[str, Any]


def point_of(values: Values, base: SensorParameters) -> Point:
    """The point of ``values``, on the sensor ``base``. Raises ParameterError where there is no such sensor."""
    tables: dict[str, Any] = {}
    settings = {name: value for name, value in values.items() if "." not in name}
    named = {name: value for name, value in values.items() if "." in name} | _following(values, base)
    for name, value in named.items():
        if name == TILE:
            tables["tile"] = tile_of(value)
            continue
        *path, last = name.split(".")
        inner = tables
        for step in path:
            inner = inner.setdefault(step, {})
        inner[last] = value
    return Point(dict(values), sensor_of(tables, base), settings)


def _following(values: Values, base: SensorParameters) -> dict[str, Any]:
    """Keys that follow from others: columns, pitch and focal length."""
    if ROWS not in values or COLS in values:
        return {}
    rows, width = values[ROWS], base.array.cols * base.array.pitch
    if PITCH not in values:
        return {COLS: rows, PITCH: width / rows}
    return {COLS: rows, FOCAL: base.optics.camera.focal_length * rows * values[PITCH] / width}


def tile_of(text: str) -> TileParameters:
    """The tile of a value of tile.types; with every type of the thesis, the thesis's own. Raises ParameterError."""
    match = re.fullmatch(r"([\d.]+(?:\+[\d.]+)*)/([1-4])", str(text))
    if not match:
        raise ParameterError(f"{TILE} = {text!r}: must be betas/orientations, as {TILES[-1]}")
    if text == TILES[-1]:
        return STANDARD.tile
    betas = [real(TILE, beta, 0, 50) for beta in match[1].split("+")]
    kinds = [
        PixelType(beta, gamma, alpha)
        for alpha in (0.0, pi / 2)
        for gamma in ORIENTATIONS[: int(match[2])]
        for beta in betas
    ]
    if len(kinds) not in SHAPES:
        raise ParameterError(f"{TILE} = {text!r}: must have {', '.join(map(str, SHAPES))} types, has {len(kinds)}")
    rows, cols = SHAPES[len(kinds)]
    return TileParameters.of_rows([kinds[row * cols : (row + 1) * cols] for row in range(rows)])


def narrowed(space: Space, text: str) -> dict[str, Any]:
    """``space`` with the keys that ``text`` names, in words: key, key=value,value or key=low..high. '' is all.

    Raises ParameterError for a key that the space does not have, and for values outside its own.
    """
    if not text.split():
        return dict(space)
    out: dict[str, Any] = {}
    for word in text.split():
        name, equals, values = word.partition("=")
        if name not in space:
            raise ParameterError(f"keys = {name!r}: must be a key of the task{nearest(name, space)}")
        out[name] = _values(name, values, space[name]) if equals else space[name]
    return out


def _values(name: str, text: str, known: list[Any] | tuple[Any, Any]) -> Any:
    if isinstance(known, list):
        chosen = [next((value for value in known if str(value) == word), None) for word in text.split(",")]
        if None in chosen:
            raise ParameterError(f"keys = {name}={text}: must be of {','.join(map(str, known))}")
        return chosen
    low, high = known
    ends = RANGE.fullmatch(text)
    words = ends.groups() if ends else text.split(",")
    numbers = [real(f"keys {name}", word, low, high) for word in words]
    if isinstance(low, int) and isinstance(high, int):
        if any(number != int(number) for number in numbers):
            raise ParameterError(f"keys = {name}={text}: must be whole numbers")
        numbers = [int(number) for number in numbers]
    if not ends:
        return numbers
    if numbers[0] > numbers[1]:
        raise ParameterError(f"keys = {name}={text}: must not be inverted")
    return tuple(numbers)


def check_space(space: Any, where: str) -> None:
    """Raise ParameterError unless ``space``, from the file ``where``, is a space of keys that a sensor has."""
    if not isinstance(space, dict) or not space:
        raise ParameterError(f"SPACE = {space!r}: must be a dict of key to values (in {where})")
    for name, values in space.items():
        if "." in str(name) and name != TILE and name not in keys():
            raise ParameterError(f"SPACE {name} = {values!r}: must be a key of sensor.toml{nearest(name, keys())}")
        number = isinstance(values, tuple) and len(values) == 2 and all(isinstance(end, int | float) for end in values)
        if not (isinstance(values, list) and values) and not (number and values[0] <= values[1]):
            raise ParameterError(f"SPACE {name} = {values!r}: must be a list of choices, or (low, high) (in {where})")


def sized(sensor: SensorParameters, part: float) -> SensorParameters:
    """The middle of the array of ``sensor``: a ``part`` of its rows and columns."""
    rows, cols = (max(round(part * count), 1) for count in sensor.shape)
    return replace(sensor, array=replace(sensor.array, rows=rows, cols=cols))
