"""One Verilog file for each top, linted on demand."""

import argparse
import sys
from importlib.metadata import version
from pathlib import Path

from talbot.base.command import main
from talbot.base.files import write
from talbot.base.paths import RESULTS
from talbot.base.sensor import Varied, add_sensor, sensor_asked
from talbot.models.parameters import SensorParameters
from talbot.rtl.harness.translate import translate_component
from talbot.rtl.lint import lint
from talbot.rtl.sensor_options import FIELDS, VARIED
from talbot.rtl.tops import PARTS, TOPS, WRAPPERS, build_top, tops_of

WRAPPER = Path(__file__).parent / "tinytapeout"
BUS = "tt_bytes"
BY_NAME = *PARTS, *WRAPPERS
# Wrappers connect buses of the standard sensor's widths
WRAPPED = {
    "tt_um_talbot_divider": Varied(
        ("chip.cordic_iterations",), {"chip.n_frac": "tt_um_talbot_divider.v connects a result of this width"}
    ),
    "tt_um_talbot_chip": Varied(
        ("array", "tile", "chip.divider", "chip.n_frac", "chip.cordic_iterations"),
        {"chip.lanes": "tt_um_talbot_chip.v connects this number of comparators"},
    ),
}


def translate(name: str, sensor: SensorParameters) -> str:
    """Return the Verilog of top, part or wrapper ``name`` for ``sensor``. Raises ParameterError."""
    if name in WRAPPERS:
        wrapper = (WRAPPER / f"{name}.v").read_text(encoding="utf-8")
        bus = [(WRAPPER / f"{BUS}.v").read_text(encoding="utf-8")] if BUS in wrapper else []
        return "\n".join((wrapper, *bus, translate(WRAPPERS[name], sensor)))
    return translate_component(build_top(name, sensor), name)


def core(name: str) -> str:
    """Return the FuseSoC core (CAPI 2) of the file of top ``name``, which holds all modules, with a target for lint."""
    return f"""CAPI=2:
name: talbot:asp:{name}:{version("talbot")}
description: "Talbot's {name}, an angle-sensitive-pixel image sensor's digital side: generated from PyMTL3"

filesets:
  rtl:
    files: [{name}.sv]
    file_type: systemVerilogSource

targets:
  default: &default
    filesets: [rtl]
    toplevel: {name}
  lint:
    <<: *default
    description: "Verilator's lint"
    flow: lint
    flow_options:
      tool: verilator
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of `talbot verilog`."""
    parser.add_argument(
        "--top",
        action="append",
        choices=(*TOPS, *BY_NAME),
        metavar="TOP",
        help=f"may be repeated: {', '.join(TOPS)} (default: all of these), or one of {', '.join(BY_NAME)}",
    )
    parser.add_argument("--out", type=Path, default=RESULTS / "verilog", help="folder of the files")
    parser.add_argument("--core", action="store_true", help="also <top>.core, for FuseSoC")
    parser.add_argument("--check", action="store_true", help="lint with Verilator, and Icarus and Yosys if installed")
    add_sensor(parser, FIELDS)


def sensor_of(options: argparse.Namespace) -> SensorParameters:
    """Return the sensor of the command line's options. Raises ParameterError."""
    sensor = sensor_asked(options, VARIED, FIELDS)
    for top in options.top or ():
        WRAPPED.get(top, Varied()).check(sensor)
    return sensor


def run(options: argparse.Namespace) -> int:
    """Write the tops' Verilog and print the files."""
    sensor = sensor_of(options)
    for name in options.top or tops_of(sensor):
        path = options.out / f"{name}.sv"
        write(path, translate(name, sensor))
        if options.core:
            write(path.with_suffix(".core"), core(name))
        print(f"{path}{': ' + ', '.join(lint(path, name)) if options.check else ''}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.modules[__name__]))
