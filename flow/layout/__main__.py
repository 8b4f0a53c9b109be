"""`python -m flow.layout DESIGN`: Verilog to a layout with all its checks, in build/layout/<design>/."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from base.paths import ROOT
from base.progress import Steps
from base.steps import StepError
from base.tools import ToolError
from models.parameters import ParameterError, check_choice
from platforms.foundry import installed
from platforms.load import PROCESSES

from .block import lay_out
from .chain import all_steps
from .design import DESIGNS, Design, design, folder_name, macro_designs
from .options import Options
from .report.metrics import broken
from .sensor.die import CHIP, SENSOR, die_steps, lay_out_sensor


def parser() -> argparse.ArgumentParser:
    """The command line's parser."""
    made = argparse.ArgumentParser(prog="python -m flow.layout", description=__doc__)
    made.add_argument("design", help=f"one of {', '.join((*DESIGNS, SENSOR))}")
    made.add_argument("--pdk", default=PROCESSES[0], help=f"process, one of {', '.join(PROCESSES)} (%(default)s)")
    made.add_argument("--backend", default="coriolis", help="what places and routes: coriolis (%(default)s)")
    made.add_argument(
        "--utilization",
        type=float,
        help="cells' area by core area where the search for the smallest area begins (the design's)",
    )
    made.add_argument(
        "--liberty",
        type=Path,
        action="append",
        default=[],
        help="characterized cells at a corner (again for further corners); default: measured now",
    )
    made.add_argument("--untimed", action="store_true", help="no timing: cells by area alone")
    made.add_argument(
        "--analog",
        type=Path,
        help=f"folder with <block>.lef and .gds of analog blocks in place of {SENSOR}'s black boxes",
    )
    made.add_argument("--out", type=Path, default=ROOT / "build" / "layout", help="folder (%(default)s)")
    return made


def one_line(error: BaseException) -> str:
    """First line of an error and, where it quotes a tool's output, the line of it that names the error."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip()] or [type(error).__name__]
    cause = next((line for line in lines[1:] if "error" in line.lower()), lines[-1])
    return lines[0] if len(lines) == 1 else f"{lines[0]} {cause}"


def main(argv: Sequence[str] | None = None) -> int:
    """Lay out a design; prints the path of its summary. 1 where a limit is broken, 2 on bad input or a failed tool."""
    arguments = parser().parse_args(argv)
    try:
        check_choice("DESIGN", arguments.design, (*DESIGNS, SENSOR))
        check_choice("backend", arguments.backend, ("coriolis",))
        chosen = design(CHIP if arguments.design == SENSOR else arguments.design)
        options = Options(
            arguments.pdk,
            chosen.utilization if arguments.utilization is None else arguments.utilization,
            tuple(arguments.liberty),
            arguments.untimed,
            decks=tuple(installed(arguments.pdk).items()),
        )
        if arguments.design == SENSOR:
            steps = [
                *(f"{CHIP}: {step.name}" for step in all_steps(chosen, options)),
                *(step.name for step in die_steps(chosen, options)),
            ]
            with Steps(steps) as bar:
                summary, lines = lay_out_sensor(chosen, options, arguments.analog, arguments.out, bar.note)
        else:
            summary, lines = block(chosen, options, arguments)
    except (ParameterError, ToolError, StepError, OSError) as error:
        print(f"flow.layout: {one_line(error)}", file=sys.stderr)
        return 2
    for line in lines:
        print(f"flow.layout: {arguments.design}: {line}", file=sys.stderr)
    print(summary)
    return 1 if lines else 0


def block(chosen: Design, options: Options, arguments: argparse.Namespace) -> tuple[Path, list[str]]:
    """Lay out a design: (path of summary.json, limits broken). Raises as `lay_out`."""
    if arguments.analog:
        raise ParameterError(f"analog = {arguments.analog}: must be with DESIGN={SENSOR} alone")
    steps = [f"{macro.name}: {step.name}" for macro in macro_designs(chosen) for step in all_steps(macro, options)]
    with Steps([*steps, *(step.name for step in all_steps(chosen, options))]) as bar:
        _, summary = lay_out(chosen, options, arguments.out, bar.note)
    return arguments.out / folder_name(chosen, options.pdk) / "summary.json", broken(summary)


if __name__ == "__main__":
    sys.exit(main())
