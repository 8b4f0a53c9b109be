"""The sensor that a command's options name: a file, and the angular response of its pixels."""

from argparse import ArgumentParser, Namespace

from talbot.base.progress import line
from talbot.models.parameters import STANDARD, SensorParameters, read_sensor
from talbot.pixels.designs import IDEAL, PIXELS


def add_pixel(parser: ArgumentParser) -> None:
    """The option of the pixels' response."""
    names = ", ".join(PIXELS)
    words = f"angular response, one of {names}: Eq. 3.1, or what the gratings of a process do; or a response.npz"
    parser.add_argument("--pixel", default=IDEAL, help=words)


def asked_sensor(options: Namespace, default: SensorParameters = STANDARD) -> SensorParameters:
    """Return the sensor of the options ``sensor`` (``default`` without a file) and ``pixel``. Raises ParameterError."""
    from talbot.pixels.tabled import tabled

    return tabled(read_sensor(options.sensor) if options.sensor else default, options.pixel, line)
