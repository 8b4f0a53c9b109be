"""`python -m flow.layout DESIGN`: Verilog to a checked layout in build/layout/<design>/."""

import argparse
import sys
from pathlib import Path

from base.paths import ROOT
from base.progress import Steps
from base.steps import StepError
from base.tools import ToolError
from models.parameters import ParameterError, check_choice
from platforms.coriolis import PROCESSES
from platforms.foundry import installed

from .block import laid_out
from .chain import Options, chain
from .design import DESIGNS, design, folder_name, macro_designs
from .report.metrics import broken
from .sensor.die import CHIP, SENSOR, laid_out_sensor, sensor_steps


def arguments():
    parser = argparse.ArgumentParser(prog="python -m flow.layout", description=__doc__.splitlines()[0])
    parser.add_argument("design", help=f"one of {', '.join((*DESIGNS, SENSOR))}")
    parser.add_argument("--pdk", default=PROCESSES[0], help=f"process, one of {', '.join(PROCESSES)} (%(default)s)")
    parser.add_argument("--backend", default="coriolis", help="what places and routes: coriolis (%(default)s)")
    parser.add_argument(
        "--utilization",
        type=float,
        help="cells' area by core area where the search for the smallest begins; default: the design's",
    )
    parser.add_argument(
        "--liberty",
        type=Path,
        action="append",
        default=[],
        help="characterized cells at a corner (again for further corners); default: measured now",
    )
    parser.add_argument("--untimed", action="store_true", help="no timing: cells by area alone")
    parser.add_argument(
        "--analog", type=Path, help=f"folder with <block>.lef and .gds of analog blocks in place of {SENSOR}'s frames"
    )
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "layout", help="folder (%(default)s)")
    return parser


def one_line(error):
    """What went wrong: the first line of an error and, of what a tool said in it, the line that tells."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip()] or [type(error).__name__]
    told = next((line for line in lines[1:] if "error" in line.lower()), lines[-1])
    return lines[0] if len(lines) == 1 else f"{lines[0]} {told}"


def main(argv=None):
    options = arguments().parse_args(argv)
    try:
        check_choice("DESIGN", options.design, (*DESIGNS, SENSOR))
        check_choice("backend", options.backend, ("coriolis",))
        chosen = design(CHIP if options.design == SENSOR else options.design)
        settings = Options(
            options.pdk,
            chosen.utilization if options.utilization is None else options.utilization,
            tuple(options.liberty),
            options.untimed,
            decks=tuple(installed(options.pdk).items()),
        )
        if options.design == SENSOR:
            summary, lines = sensor(chosen, settings, options)
        else:
            summary, lines = block(chosen, settings, options)
    except (ParameterError, ToolError, StepError, OSError) as error:
        print(f"flow.layout: {one_line(error)}", file=sys.stderr)
        return 2
    for line in lines:
        print(f"flow.layout: {options.design}: {line}", file=sys.stderr)
    print(summary)
    return 1 if lines else 0


def block(chosen, settings, options):
    """(summary.json's path, limits broken) of a design laid out. Raises as `laid_out`."""
    if options.analog:
        raise ParameterError(f"analog = {options.analog}: must be with DESIGN={SENSOR} alone")
    steps = [f"{block.name}: {step.name}" for block in macro_designs(chosen) for step in chain(block, settings)]
    with Steps([*steps, *(step.name for step in chain(chosen, settings))]) as bar:
        _, summary = laid_out(chosen, settings, options.out, bar.note)
    return options.out / folder_name(chosen, options.pdk) / "summary.json", broken(summary)


def sensor(chip, settings, options):
    """The same of the whole sensor. chip: Design of its digital part."""
    steps = [
        *(f"{CHIP}: {step.name}" for step in chain(chip, settings)),
        *(step.name for step in sensor_steps(chip, settings)),
    ]
    with Steps(steps) as bar:
        path, lines = laid_out_sensor(chip, settings, options.analog, options.out, bar.note)
    return path, lines


if __name__ == "__main__":
    sys.exit(main())
