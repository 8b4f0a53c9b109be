"""A sensor file, TOML: every parameter of a sensor with its meaning, unit and range. `talbot sensor > sensor.toml`."""

from argparse import ArgumentParser, Namespace
from pathlib import Path

from talbot.base.files import check_file, write
from talbot.models.parameters import STANDARD, read_sensor, sensor_text


def add_arguments(parser: ArgumentParser) -> None:
    """Arguments of `talbot sensor`."""
    parser.add_argument(
        "file", type=Path, nargs="?", help="a sensor file to check and complete (default: the standard)"
    )
    parser.add_argument("--out", type=Path, help="file to write (default: print)")


def run(options: Namespace) -> int:
    """Print or write the sensor with every key."""
    if options.out:
        check_file("out", options.out)
    text = sensor_text(read_sensor(options.file) if options.file else STANDARD)
    if options.out:
        write(options.out, text)
        print(f"written: {options.out}")
    else:
        print(text, end="")
    return 0
