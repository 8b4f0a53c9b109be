"""A sensor as a file, sensor.toml: a table for each part of `SensorParameters`, a key for each field.

Names, ranges and the comments of a written file come from the classes themselves. What a file leaves out has the value
of `STANDARD`; of a tile without types it is the first of the thesis's.
"""

import difflib
import inspect
import math
import re
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import MISSING, fields, is_dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

from talbot.models.parameters.checks import ParameterError
from talbot.models.parameters.circuit import circuit_converter
from talbot.models.parameters.sensor import SensorParameters
from talbot.models.parameters.tile import PixelType, TileParameters

STANDARD = SensorParameters(converter=circuit_converter())
BYTES_MAX = 1 << 20


def read_sensor(path: str | Path) -> SensorParameters:
    """Read a sensor file.

    path: the file, TOML. Returns the sensor. Raises ParameterError for a file that is missing or no TOML, an unknown
    key, or a value out of range.
    """
    path = Path(path)
    if not path.is_file():
        raise ParameterError(f"sensor = {str(path)!r}: no such file; must be a TOML file, as talbot sensor prints")
    if path.stat().st_size > BYTES_MAX:
        raise ParameterError(f"sensor = {str(path)!r}: must have at most {BYTES_MAX} bytes")
    try:
        table = tomllib.loads(path.read_bytes().decode("utf-8-sig"))
    except (ValueError, RecursionError) as error:  # ValueError: of an integer with thousands of digits, too
        raise ParameterError(f"sensor = {str(path)!r}: must be a TOML file ({error})") from None
    try:
        return sensor_of(table)
    except ParameterError as error:
        raise ParameterError(printable(f"{error} (in {path})")) from None


def sensor_of(table: Mapping[str, Any], base: SensorParameters = STANDARD) -> SensorParameters:
    """Sensor of nested tables.

    table: as in the file: {'array': {'rows': 64}, 'optics': {'m': 0.5, 'camera': {'focus': 0.3}}}. A part may also be
    the object itself: {'tile': TileParameters.small(2, 2)}. base: has the values that are left out. Returns the sensor.
    Raises ParameterError for an unknown key, or a value out of range: with what the key means.
    """
    return _part(base, table, "")


def sensor_text(sensor: SensorParameters = STANDARD) -> str:
    """Text of a sensor file.

    sensor: the sensor. Returns TOML, every key with its meaning, unit and range; None is a comment. Raises
    ParameterError for a pixel type with a response that does not name its source: a function has no text.
    """
    return "# A sensor of Talbot. Any key may be left out: it has the value of `talbot sensor` then.\n" + "".join(
        line + "\n" for line in _lines(sensor, "")
    )


@cache
def keys(kind: type[Any] = SensorParameters, prefix: str = "") -> dict[str, str]:
    """Every key of the file.

    kind: class of the part. prefix: its name with a dot behind it, '' for the whole. Returns full name
    ('optics.camera.focus') to meaning, unit and range.
    """
    meanings: dict[str, str] = {}
    for name, text in _meanings(kind).items():
        part = _parts(kind).get(name)
        meanings |= {f"{prefix}{name}": text} | (keys(part, f"{prefix}{name}.") if part else {})
    return meanings


def values(part: Any, prefix: str = "") -> dict[str, Any]:
    """Values of the fields that are no tables.

    part: the sensor. prefix: the part's name with a dot behind it, '' for the whole. Returns full name
    ('optics.camera.focus') to value.
    """
    out: dict[str, Any] = {}
    for item in fields(part):
        name, value = f"{prefix}{item.name}", getattr(part, item.name)
        out |= values(value, f"{name}.") if item.name in _parts(type(part)) else {name: value}
    return out


def nearest(key: str, known: Iterable[str], cutoff: float = 0.7) -> str:
    """Return the hint of an error for an unknown key.

    key: the key. known: names that there are, full ones perhaps. cutoff: how like the key the nearest must be, 0..1.
    Returns 'did you mean ...?', or all names.
    """
    known = [*known]
    ends = {name.rpartition(".")[2]: name for name in known}
    near = difflib.get_close_matches(key, [*known, *ends], 1, cutoff)
    return f"; did you mean {ends.get(near[0], near[0])}?" if near else f": {', '.join(known)}"


def printable(text: str) -> str:
    """Show what has no glyph as Python writes it: line ends, controls of a terminal, bytes of a name that is no UTF-8.

    text: any. Returns str: one line.
    """
    return "".join(character if character.isprintable() else repr(character)[1:-1] for character in text)


@cache
def _meanings(kind: type[Any]) -> dict[str, str]:
    """Field to its text in the class's docstring, in one line."""
    texts: dict[str, str] = {}
    text = inspect.cleandoc(kind.__doc__ or "")  # Python 3.13 does so itself
    section = re.split(r"\nAttributes\n-+\n|\n\n\w+\n-+\n", text)[1:2]
    for names, text in re.findall(r"^(\w[\w, ]*) : .*\n((?: {4}.*\n?)+)", section[0] if section else "", re.M):
        texts |= dict.fromkeys(names.split(", "), " ".join(text.split()).removesuffix("."))
    return {item.name: texts.get(item.name, "") for item in fields(kind)}


@cache
def _parts(kind: type[Any]) -> dict[str, type[Any]]:
    """Fields of a class that are such classes themselves."""
    return {item.name: item.type for item in fields(kind) if isinstance(item.type, type) and is_dataclass(item.type)}


def _part(base: Any, table: Any, where: str) -> Any:
    """``base`` with the values of ``table``; where: its full name with a dot behind it, '' for the whole."""
    kind, parts = type(base), _parts(type(base))
    if isinstance(table, kind):
        return table
    _check_keys(table, _meanings(kind), where, keys())
    if isinstance(base, TileParameters):
        return _checked(lambda: _tile(table), TileParameters, where)
    values = {
        key: _part(getattr(base, key), value, f"{where}{key}.") if key in parts else value
        for key, value in table.items()
    }
    return _checked(lambda: replace(base, **values), kind, where)


def _check_keys(table: Any, known: Mapping[str, str], where: str, everywhere: Mapping[str, str]) -> None:
    name = where.removesuffix(".")
    if not isinstance(table, Mapping):
        raise ParameterError(f"{name} = {table!r}: must be a table, [{name}]")
    for key in table.keys() - known.keys():
        elsewhere = key in {full.rpartition(".")[2] for full in everywhere}  # right, but in another table
        near = nearest(key, everywhere if elsewhere else known)
        of = f"[{name}]" if name else "a sensor"
        raise ParameterError(printable(f"{where}{key} = {table[key]!r}: must be a key of {of}{near}"))


def _tile(table: Mapping[str, Any]) -> TileParameters:
    size = {name: table.get(name, default) for name, default in (("rows", 4), ("cols", 6))}
    if "types" not in table:
        tile = TileParameters.small(**size)
        return replace(tile, order=table["order"]) if "order" in table else tile
    if not isinstance(table["types"], list):
        raise ParameterError(f"types = {table['types']!r}: must be a list of tables")
    types = tuple(_type(entry, f"tile.types[{i}].") for i, entry in enumerate(table["types"]))
    return TileParameters(**size, types=types, order=table.get("order", range(len(types))))


def _type_keys() -> dict[str, str]:
    return {name: text for name, text in _meanings(PixelType).items() if name != "response"}


def _type(table: Any, where: str) -> PixelType:
    known = _type_keys()
    _check_keys(table, known, where, known)
    for item in fields(PixelType):
        if item.default is MISSING and item.name not in table:
            raise ParameterError(f"{where}{item.name} = None: must be there ({known[item.name]})")
    return _checked(lambda: PixelType(**table), PixelType, where)


def _checked(make: Callable[[], Any], kind: type[Any], where: str) -> Any:
    """Return the result of ``make``; its error has the full name and its meaning."""
    try:
        return make()
    except ParameterError as error:
        name = str(error).partition(" = ")[0]
        if name.partition(".")[0] in {item.name for item in fields(SensorParameters)}:  # a part's, with its full name
            raise
        text = _meanings(kind).get(name.split()[-1])
        said = f"{where}{str(error).removeprefix(where.replace('.', ' '))}"  # 'tile rows' is tile.rows
        raise ParameterError(f"{said}{f' ({text})' if text else ''}") from None


def _lines(part: Any, where: str) -> Iterator[str]:
    kind, inner = type(part), []
    if where:
        yield f"\n[{where.removesuffix('.')}]"
    for item in fields(kind):
        value, text = getattr(part, item.name), _meanings(kind)[item.name]
        if item.name in _parts(kind):
            inner.append((value, f"{where}{item.name}."))
        elif isinstance(value, tuple) and value and isinstance(value[0], PixelType):
            yield f"# {text}"
            yield from (f"#   {name}: {meaning}" for name, meaning in _type_keys().items())
            yield "types = ["
            yield from (f"    {_type_text(entry)},{_response_text(entry)}" for entry in value)
            yield "]"
        else:
            source = item.metadata.get("source") if value == item.default else None
            yield f"# {text}" + (f" ({source})" if source else "")
            yield f"# {item.name} =" if value is None else f"{item.name} = {_value(value)}"
    for value, name in inner:
        yield from _lines(value, name)


def _response_text(kind: PixelType) -> str:
    """Return a comment that names what made a type's response; it has no text itself."""
    if kind.response is None:
        return ""
    source = getattr(kind.response, "source", None)
    if source is None:
        raise ParameterError("tile.types.response = a function: must be None in a sensor file")
    return f"  # its response is that of {source}"


def _type_text(kind: PixelType) -> str:
    values = {name: getattr(kind, name) for name in _type_keys()}
    return "{ " + ", ".join(f"{name} = {_value(v)}" for name, v in values.items() if v is not None) + " }"


def _value(value: Any) -> str:
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, tuple):
        return f"[{', '.join(map(_value, value))}]"
    return repr(float(value)) if isinstance(value, float) or math.trunc(value) != value else str(int(value))
