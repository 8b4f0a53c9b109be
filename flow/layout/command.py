"""Verilog to a layout with all its checks, in build/layout/<design>/."""

import json
from argparse import ArgumentParser, Namespace
from pathlib import Path

from talbot.base.command import failures
from talbot.base.paths import RESULTS
from talbot.base.progress import Steps
from talbot.base.sensor import add_sensor, sensor_asked
from talbot.flow.layout.block import lay_out
from talbot.flow.layout.chain import all_steps
from talbot.flow.layout.design import DESIGNS, Design, design, folder_name
from talbot.flow.layout.options import Options
from talbot.flow.layout.report.metrics import broken
from talbot.flow.layout.report.page import closing
from talbot.flow.layout.sensor.die import CHIP, SENSOR, die_steps, lay_out_sensor
from talbot.flow.layout.sensor.plan import BLOCKS
from talbot.flow.layout.varied import VARIED
from talbot.models.parameters import ParameterError, check_choice
from talbot.platforms.foundry import installed
from talbot.platforms.processes import PROCESSES


def add_arguments(parser: ArgumentParser) -> None:
    """Arguments of `talbot layout`."""
    add = parser.add_argument
    add("design", nargs="?", default=CHIP, help=f"one of {', '.join((*DESIGNS, SENSOR))}")
    add_sensor(parser)
    add("--pdk", default=PROCESSES[0], help=f"process, one of {', '.join(PROCESSES)}")
    add("--utilization", type=float, help="cells' area by core area where the search begins (default: the design's)")
    cells = "characterized cells at a corner (again for further corners; default: those shipped)"
    add("--liberty", type=Path, action="append", default=[], help=cells)
    add("--analog", type=Path, help=f"folder with <block>.lef and .gds in place of {SENSOR}'s black boxes")
    add("--out", type=Path, default=RESULTS / "layout", help="folder of the layouts")


def run(arguments: Namespace) -> int:
    """Lay out a design and print what came of it; 1 where a limit is broken."""
    sensor_asked(arguments, VARIED)
    check_choice("DESIGN", arguments.design, (*DESIGNS, SENSOR))
    chosen = design(CHIP if arguments.design == SENSOR else arguments.design)
    start = chosen.utilization if arguments.utilization is None else arguments.utilization
    decks = tuple(installed(arguments.pdk).items())
    options = Options(arguments.pdk, start, tuple(arguments.liberty), decks=decks)
    if arguments.design == SENSOR:
        steps = [f"{CHIP}: {step.name}" for step in all_steps(chosen, options)]
        steps += [step.name for step in die_steps(chosen, options, BLOCKS)]
        with Steps(steps, lines=True) as bar:
            summary, lines = lay_out_sensor(chosen, options, arguments.analog, arguments.out, bar.note)
    else:
        summary, lines = block(chosen, options, arguments)
    print(f"{arguments.design}: laid out")
    print(closing(json.loads(summary.read_text(encoding="utf-8")), lines, summary.with_name("report.html")))
    return failures(f"{arguments.design}: {line}" for line in lines)


def block(chosen: Design, options: Options, arguments: Namespace) -> tuple[Path, list[str]]:
    """Lay out a design: (path of summary.json, limits broken). Raises as `lay_out`."""
    if arguments.analog:
        raise ParameterError(f"analog = {arguments.analog}: must be with DESIGN={SENSOR} alone")
    with Steps([step.name for step in all_steps(chosen, options)], lines=True) as bar:
        _, summary = lay_out(chosen, options, arguments.out, bar.note)
    return arguments.out / folder_name(chosen, options.pdk) / "summary.json", broken(summary)
