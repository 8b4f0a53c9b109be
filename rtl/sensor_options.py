"""Options of the Verilog's export, and the fields of a sensor that they replace."""

from argparse import ArgumentParser
from collections.abc import Sequence

from talbot.base.sensor import Varied, add_sensor, sensor_asked
from talbot.models.parameters import STANDARD, SensorParameters
from talbot.models.parameters.sensor_file import values

FIELDS = {
    "rows": "array.rows",
    "cols": "array.cols",
    "lanes": "chip.lanes",
    "tile-rows": "tile.rows",
    "tile-cols": "tile.cols",
    "order": "tile.order",
    "divider": "chip.divider",
    "n-frac": "chip.n_frac",
    "iterations": "chip.cordic_iterations",
}
VARIED = Varied(used=tuple(FIELDS.values()))


def options_of(sensor: SensorParameters) -> tuple[str, ...]:
    """Options with which the export writes the Verilog of ``sensor``; () for the standard sensor's."""
    own, standard = values(sensor), values(STANDARD)
    tile = any(own[name] != standard[name] for name in ("tile.rows", "tile.cols", "tile.order"))
    return tuple(
        f"--{option}={','.join(map(str, value)) if isinstance(value := own[name], tuple) else value}"
        for option, name in FIELDS.items()
        if own[name] != standard[name] or (tile and name.startswith("tile."))
    )


def sensor_with(options: Sequence[str]) -> SensorParameters:
    """Return the standard sensor with the fields of ``options``, as `options_of` writes them. Raises ParameterError."""
    parser = ArgumentParser()
    add_sensor(parser, FIELDS)
    return sensor_asked(parser.parse_args(options), VARIED, FIELDS)
