"""One Verilog file for each top, linted on demand."""

import argparse
import sys
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path

from talbot.base.command import main
from talbot.base.files import write
from talbot.base.paths import RESULTS
from talbot.models.parameters import (
    DIVIDERS,
    ArrayParameters,
    ChipParameters,
    ParameterError,
    SensorParameters,
    TileParameters,
)
from talbot.rtl.harness.translate import translate_component
from talbot.rtl.lint import lint
from talbot.rtl.tops import PARTS, TOPS, WRAPPERS, build_top

WRAPPER = Path(__file__).parent / "tinytapeout"
BUS = "tt_bytes"
BY_NAME = *PARTS, *WRAPPERS


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
    sensor = SensorParameters()
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
    parser.add_argument("--rows", type=int, default=sensor.array.rows, help="pixels down")
    parser.add_argument("--cols", type=int, default=sensor.array.cols, help="pixels across")
    parser.add_argument("--lanes", type=int, default=sensor.chip.lanes, help="converters")
    parser.add_argument("--tile-rows", type=int, default=sensor.tile.rows, help="pixels down a tile, 1..4")
    parser.add_argument("--tile-cols", type=int, default=sensor.tile.cols, help="pixels across a tile, 1..6")
    parser.add_argument(
        "--order", help="pixel type of each position in a tile, row by row: 3,0,2,1 (default: the thesis's)"
    )
    parser.add_argument("--divider", default=sensor.chip.divider, help=f"one of {', '.join(DIVIDERS)}")
    parser.add_argument("--n-frac", type=int, default=sensor.chip.n_frac, help="fraction bits")
    parser.add_argument("--iterations", type=int, default=sensor.chip.cordic_iterations, help="of CORDIC")


def sensor_of(options: argparse.Namespace) -> SensorParameters:
    """Return the sensor of the command line's options. Raises ParameterError."""
    return SensorParameters(
        tile=_tile(options),
        array=ArrayParameters(options.rows, options.cols),
        chip=ChipParameters(options.lanes, options.divider, options.n_frac, options.iterations),
    )


def _tile(options: argparse.Namespace) -> TileParameters:
    tile = TileParameters.small(options.tile_rows, options.tile_cols)
    if options.order is None:
        return tile
    if not all(word.strip().isdecimal() for word in options.order.split(",")):
        raise ParameterError(f"order = {options.order!r}: must be a permutation of 0..{tile.n_types - 1}, as 3,0,2,1")
    return replace(tile, order=tuple(int(word) for word in options.order.split(",")))


def run(options: argparse.Namespace) -> int:
    """Write the tops' Verilog and print the files."""
    sensor = sensor_of(options)
    for name in options.top or TOPS:
        path = options.out / f"{name}.sv"
        write(path, translate(name, sensor))
        if options.core:
            write(path.with_suffix(".core"), core(name))
        print(f"{path}{': ' + ', '.join(lint(path, name)) if options.check else ''}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.modules[__name__]))
