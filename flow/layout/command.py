"""Verilog to a layout with all its checks, in build/layout/<design>/."""

import json
from argparse import ArgumentParser, Namespace
from pathlib import Path

from talbot.base.arguments import number_of
from talbot.base.command import failures
from talbot.base.paths import RESULTS
from talbot.base.progress import Steps
from talbot.base.sensor import add_sensor, sensor_asked
from talbot.flow.layout.block import lay_out
from talbot.flow.layout.chain import all_steps
from talbot.flow.layout.design import DESIGNS, Design, design_asked, folder_name
from talbot.flow.layout.options import Options
from talbot.flow.layout.report.metrics import broken
from talbot.flow.layout.report.page import closing
from talbot.flow.layout.sensor.die import die_steps, lay_out_sensor
from talbot.flow.layout.sensor.plan import BLOCKS
from talbot.flow.layout.varied import CHIP, SENSOR, varied
from talbot.flow.layout.verilog import design_of
from talbot.models.parameters import ParameterError, check_choice
from talbot.pixels.test_chip import job as test_chip
from talbot.platforms.foundry import installed
from talbot.platforms.processes import PROCESSES

NAMES = *DESIGNS, SENSOR, test_chip.DESIGN
# Options of designs of cells: tt_pixels has none
OF_CELLS = "sensor", "top", "clock", "reset", "period_ns", "utilization", "liberty", "analog", "wrapper"


def add_arguments(parser: ArgumentParser) -> None:
    """Arguments of `talbot layout`."""
    add = parser.add_argument
    add("design", nargs="?", help=f"one of {', '.join(NAMES)} (default: {CHIP})")
    add_sensor(parser)
    files = "your own design, in place of ours: a Verilog file (again for further files); needs --top"
    add("--verilog", type=Path, action="append", default=[], help=files)
    add("--top", help="its module")
    add("--clock", help="its clock, whose rising edge alone registers take (default: clk)")
    add("--reset", help="its synchronous reset, active at 0 if the name ends in _n (default: none)")
    add("--period-ns", type=number_of, help="its clock period, 0.5..10000 ns (default: 20)")
    add("--pdk", default=PROCESSES[0], help=f"process, one of {', '.join(PROCESSES)}")
    add(
        "--utilization", type=number_of, help="cells' area by core area where the search begins (default: the design's)"
    )
    cells = "characterized cells at a corner (again for further corners; default: those shipped)"
    add("--liberty", type=Path, action="append", default=[], help=cells)
    add("--analog", type=Path, help=f"folder with <block>.lef and .gds in place of {SENSOR}'s black boxes")
    wrapper = f"a shuttle's empty wrapper (GDS), in which {SENSOR} is laid out without pads"
    add("--wrapper", type=Path, help=wrapper)
    add("--out", type=Path, default=RESULTS / "layout", help="folder of the layouts")


def run(arguments: Namespace) -> int:
    """Lay out a design and print what came of it; 1 where a limit is broken."""
    if arguments.design == test_chip.DESIGN and not arguments.verilog:
        return pixels(arguments)
    chosen = chosen_design(arguments)
    start = chosen.utilization if arguments.utilization is None else arguments.utilization
    decks = tuple(installed(arguments.pdk).items())
    options = Options(arguments.pdk, start, tuple(arguments.liberty), decks=decks)
    name = arguments.design or chosen.name
    if name == SENSOR:
        steps = [f"{CHIP}: {step.name}" for step in all_steps(chosen, options)]
        steps += [step.name for step in die_steps(chosen, options, BLOCKS, wrapped=bool(arguments.wrapper))]
        sensor = sensor_asked(arguments, varied(name))
        with Steps(steps, lines=True) as bar:
            summary, lines = lay_out_sensor(
                chosen, options, arguments.analog, arguments.out, bar.note, sensor, arguments.wrapper
            )
    else:
        summary, lines = block(chosen, options, arguments)
    print(f"{name}: laid out")
    print(closing(json.loads(summary.read_text(encoding="utf-8")), lines, summary.with_name("report.html")))
    return failures(f"{name}: {line}" for line in lines)


def chosen_design(arguments: Namespace) -> Design:
    """The Design of the arguments, of a user's Verilog or of DESIGNS; that of the die is the chip's."""
    of_verilog = {name: getattr(arguments, name) for name in ("top", "clock", "reset", "period_ns")}
    if not arguments.verilog:
        if typed := next((name for name, value in of_verilog.items() if value is not None), None):
            raise ParameterError(f"{typed} = {of_verilog[typed]}: must be with VERILOG, a user's own design")
        check_choice("DESIGN", arguments.design or CHIP, NAMES)
        return design_asked(arguments.design or CHIP, arguments)
    if arguments.design:
        raise ParameterError(f"DESIGN = {arguments.design!r}: must not be with VERILOG, which has its own top")
    if arguments.sensor:
        raise ParameterError(f"sensor = {arguments.sensor}: must not be with VERILOG, which has its own sizes")
    if not arguments.top:
        raise ParameterError("top = '': must be a module of VERILOG")
    return design_of(arguments.verilog, **{name: value for name, value in of_verilog.items() if value is not None})


def pixels(arguments: Namespace) -> int:
    """Lay out the pixels' test chip and print what came of it; 1 where a check fails."""
    for name in OF_CELLS:
        if (value := getattr(arguments, name)) not in (None, []):
            raise ParameterError(f"{name} = {value}: must not be with DESIGN={test_chip.DESIGN}, which has no cells")
    folder = arguments.out / arguments.design
    with Steps(test_chip.STEPS, lines=True) as bar:
        summary = test_chip.make(arguments.pdk, folder, bar.note)
    print(f"{arguments.design}: laid out")
    print(test_chip.line(summary, folder))
    lines = [f"design rule {rule}: {count} violations" for rule, count in summary["drc"].items()]
    lines += [f"LVS: {', '.join(summary['lvs_differs'][:5])}"] * (not summary["lvs_match"])
    lines += [f"output {name}: not on ground" for name in summary["untied"]]
    return failures(f"{arguments.design}: {line}" for line in lines)


def block(chosen: Design, options: Options, arguments: Namespace) -> tuple[Path, list[str]]:
    """Lay out a design: (path of summary.json, limits broken). Raises as `lay_out`."""
    for option in ("analog", "wrapper"):
        if value := getattr(arguments, option):
            raise ParameterError(f"{option} = {value}: must be with DESIGN={SENSOR} alone")
    with Steps([step.name for step in all_steps(chosen, options)], lines=True) as bar:
        _, summary = lay_out(chosen, options, arguments.out, bar.note)
    return arguments.out / folder_name(chosen, options.pdk) / "summary.json", broken(summary)
