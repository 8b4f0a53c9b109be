"""The sensor of a command: --sensor FILE, options that replace its fields, and fields that a command cannot vary."""

from argparse import ArgumentParser, Namespace
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from talbot.base.arguments import number_of, whole_of
from talbot.models.parameters import STANDARD, ParameterError, SensorParameters, TileParameters, read_sensor
from talbot.models.parameters.sensor_file import keys, values

HELP = "sensor file; talbot sensor writes one to start from"
SHOWN = 60  # characters of a value in an error
READ = {int: whole_of, float: number_of, str: str}  # texts of options


@dataclass(frozen=True)
class Varied:
    """Fields of a sensor file that a command varies or refuses. A name is a field, or a table for all of its fields.

    used: the result follows them. fixed: the result depends on them, and they cannot vary yet: the reason of each.
    limits: of used fields, least and greatest value where these are narrower than the sensor's own.
    steps: of used fields, the step of which a value is a multiple.
    The result does not depend on fields that are in neither.
    """

    used: tuple[str, ...] = ()
    fixed: Mapping[str, str] = field(default_factory=dict)
    limits: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    steps: Mapping[str, float] = field(default_factory=dict)

    def uses(self, name: str) -> bool:
        """Return whether the result follows the field ``name``."""
        return any(_within(name, key) for key in self.used)

    def fixes(self, name: str) -> str:
        """Return the reason for which the field ``name`` cannot vary, '' where it can."""
        return next((reason for key, reason in self.fixed.items() if _within(name, key)), "")

    def check(self, sensor: SensorParameters, *also: SensorParameters) -> None:
        """Check limits, steps, and that each fixed field of ``sensor`` is the standard's, or that of one of ``also``.

        Raises ParameterError.
        """
        default, others = values(STANDARD), [values(other) for other in also]
        for name, value in values(sensor).items():
            varied = f"this command varies {', '.join(self.used) or 'nothing'}"
            if (reason := self.fixes(name)) and value not in (default[name], *(other[name] for other in others)):
                raise ParameterError(f"{name} = {_text(value)}: must be {_text(default[name])} ({reason}; {varied})")
            if name in self.limits and not self.limits[name][0] <= value <= self.limits[name][1]:
                low, high = self.limits[name]
                raise ParameterError(f"{name} = {_text(value)}: must be in {low:g}..{high:g} ({varied})")
            if (step := self.steps.get(name)) and abs(value / step - round(value / step)) > 1e-6:
                raise ParameterError(f"{name} = {value:.9g}: must be a multiple of {step:g} ({varied})")


def standard_alone(reason: str) -> Varied:
    """Return what a command varies that takes the standard sensor alone: nothing, for ``reason``."""
    return Varied(fixed=dict.fromkeys((part.name for part in fields(SensorParameters)), reason))


def add_sensor(parser: ArgumentParser, replaced: Mapping[str, str] | None = None) -> None:
    """Add --sensor, and an option for each of ``replaced``: name of an option to name of the field it replaces."""
    parser.add_argument("--sensor", type=Path, help=HELP)
    standard = values(STANDARD)
    for option, name in (replaced or {}).items():
        meaning, default = keys()[name], standard[name]
        if isinstance(default, tuple):
            parser.add_argument(f"--{option}", help=f"{meaning}; with commas (default: the sensor file's)")
        else:
            note = f"{meaning} (default: the sensor file's, {default})"
            parser.add_argument(f"--{option}", type=READ[type(default)], help=note)


def sensor_asked(options: Namespace, varied: Varied, replaced: Mapping[str, str] | None = None) -> SensorParameters:
    """Return the sensor of the options of `add_sensor`. Raises ParameterError."""
    sensor = read_sensor(options.sensor) if options.sensor else STANDARD
    parts: dict[str, Any] = {}
    for option, name in (replaced or {}).items():
        value, (part, _, key) = getattr(options, option.replace("-", "_")), name.partition(".")
        if value is not None:
            base = parts.get(part, getattr(sensor, part))
            parts[part] = _tile(base, key, value) if part == "tile" else replace(base, **{key: value})
    sensor = replace(sensor, **parts)  # at once: an array may be too large for the tile before
    varied.check(sensor)
    return sensor


def labelled(name: str, options: Namespace) -> str:
    """``name`` of a folder, with the sensor file's where there is one: results of two sensors are in two folders."""
    return f"{name}-{Path(options.sensor).stem}" if options.sensor else name


def _tile(tile: TileParameters, key: str, value: Any) -> TileParameters:
    """``tile`` with rows, cols or order changed. One of another size has the first of the standard types."""
    if key != "order":
        return TileParameters.small(**{"rows": tile.rows, "cols": tile.cols} | {key: value})
    if not all(word.strip().isdecimal() for word in value.split(",")):
        raise ParameterError(f"order = {value!r}: must be a permutation of 0..{tile.n_types - 1}, as 3,0,2,1")
    return replace(tile, order=tuple(map(int, value.split(","))))


def _within(name: str, key: str) -> bool:
    return name == key or name.startswith(f"{key}.")


def _text(value: Any) -> str:
    """Return a value as a line of an error has it."""
    if isinstance(value, tuple) and value and not isinstance(value[0], int):
        return f"{len(value)} pixel types" if value != STANDARD.tile.types else "the standard's pixel types"
    if isinstance(value, tuple):
        text = ",".join(map(str, value))
        return text if len(text) <= SHOWN else f"{text[:SHOWN]}..."
    return str(value) if isinstance(value, str | int) or value is None else f"{value:g}"
