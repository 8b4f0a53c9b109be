"""Lay out the sensor's die: the chip first, the analog blocks, drawn or black boxes, then the die's own steps."""

import json
import shutil
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
from pathlib import Path
from typing import Any

from talbot.base.files import staged
from talbot.base.steps import Runner, Step, StepError
from talbot.flow.layout.block import lay_out
from talbot.flow.layout.design import Design, folder_name
from talbot.flow.layout.options import Options
from talbot.flow.layout.report.metrics import broken
from talbot.flow.layout.report.page import picture, write_report
from talbot.flow.layout.report.picture import render
from talbot.flow.layout.sensor import package
from talbot.flow.layout.sensor.analog import files
from talbot.flow.layout.sensor.metrics import RULES, summarize
from talbot.flow.layout.sensor.picture import by_block
from talbot.flow.layout.sensor.plan import DieParameters
from talbot.flow.layout.sensor.steps.die_antenna import DieAntenna
from talbot.flow.layout.sensor.steps.die_connectivity import DieConnectivity
from talbot.flow.layout.sensor.steps.die_drc import DieDrc, DieFoundryDrc
from talbot.flow.layout.sensor.steps.die_esd import DieEsd
from talbot.flow.layout.sensor.steps.die_gds import DieGds, DieGdsParameters
from talbot.flow.layout.sensor.steps.die_ir_drop import DieIrDrop, DieIrDropParameters
from talbot.flow.layout.sensor.steps.die_pads import DiePads, DiePadsDrc, DiePadsLvs
from talbot.flow.layout.sensor.steps.die_parasitics import DieParasitics, DieParasiticsParameters
from talbot.flow.layout.sensor.steps.die_plan import DiePlan, DiePlanParameters
from talbot.flow.layout.sensor.steps.die_sta import DieSta
from talbot.flow.layout.sensor.steps.drawing import ARRAY, DrawingParameters, DrawnCircuits, DrawnPixels
from talbot.flow.layout.sensor.steps.wrapped import WrappedGds, WrappedPlan
from talbot.flow.layout.sensor.wrapper import check_wrapper
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.flow.layout.steps.sta import StaParameters
from talbot.flow.layout.varied import CHIP, SENSOR
from talbot.models.parameters import STANDARD, SensorParameters
from talbot.pixels.analog_layout.drawable import check_drawable
from talbot.pixels.layout.write import tile_geometries
from talbot.platforms.die import top_metal
from talbot.platforms.layout import layout_platform
from talbot.platforms.pads import pad_process
from talbot.platforms.pixel import pixel_process
from talbot.platforms.wires import CORNERS
from talbot.platforms.wrapper import wrappers
from talbot.signoff.foundry_drc import FoundryDrcParameters

# Files of the chip's run that the die is given
PARTS = {"core.lef": "lef.lef", "core.gds": "fill.gds", "core.sdc": "sdc"}
PARTS |= {f"core.{wires}": f"extraction.{wires}" for wires in CORNERS}
PARTS |= {"core.verilog": "stream_out.verilog", "library.rules": "library.rules"}
PARTS |= {f"library.{deck}": f"library.{deck}" for deck in ("drc", "lvs")}
RESULTS = {"gds": "die_gds.gds", "v": "die_plan.verilog", "sdc": "die_parasitics.sdc", "drc.lyrdb": "die_drc.report"}
RESULTS |= {"connectivity.json": "die_connectivity.report", "parasitics.json": "die_parasitics.nets"}
RESULTS |= {"esd.json": "die_esd.report"}
PINS, PACKAGE = f"{SENSOR}.pins.md", (f"{SENSOR}.package.png", f"{SENSOR}.package.svg")
WRAPPED = "wrapped"  # label of the folder of a sensor in a wrapper
SHUTTLE = "shuttle"  # folder of the files for its repository


def die_steps(
    chip: Design,
    options: Options,
    drawn: Sequence[str] = (),
    die: DieParameters | None = None,
    sensor: SensorParameters = STANDARD,
    wrapped: bool = False,
) -> list[Step]:
    """The die's steps, of those that can begin the longest first.

    drawn: blocks that this project draws, for ``sensor``. die: see DiePlanParameters. wrapped: whether the die is in a
    shuttle's wrapper, without pads.
    """
    pdk, clock, io = options.pdk, chip.clock, chip.io
    ns = {"input_ns": io.input_delay * clock.period_ns, "output_ns": io.output_delay * clock.period_ns}
    parasitics = DieParasiticsParameters(pdk, clock.port, load_pf=io.load_pf, **ns)
    drawings = [step(DrawingParameters(pdk, sensor)) for step in (DrawnPixels, DrawnCircuits)]
    drawings = [step for step in drawings if any(f"{block}.lef" in step.outputs for block in drawn)]
    steps: list[Step] = [
        *([] if wrapped else [DiePads(PdkParameters(pdk))]),
        (WrappedPlan if wrapped else DiePlan)(DiePlanParameters(pdk, die or DieParameters())),
        (WrappedGds if wrapped else DieGds)(DieGdsParameters(pdk, tuple(drawn))),
        *([DieFoundryDrc(FoundryDrcParameters(pdk, SENSOR))] if "klayout" in dict(options.decks) else []),
        DieDrc(PdkParameters(pdk)),
        DieConnectivity(PdkParameters(pdk)),
        DieAntenna(PdkParameters(pdk)),
        DieParasitics(parasitics),
        *(DieSta(StaParameters(chip.top, corner, clock.period_ns)) for corner in options.corners),
        *([DieIrDrop(DieIrDropParameters(pdk, sensor.array))] if ARRAY in drawn else []),
        *([] if wrapped else [kind(PdkParameters(pdk)) for kind in (DiePadsDrc, DiePadsLvs, DieEsd)]),
    ]
    own = {name: f"{step.name}.{name}" for step in drawings for name in step.outputs if name.split(".")[0] in drawn}
    for step in steps:
        step.inputs = {name: own.get(source, source) for name, source in step.inputs.items()}
    return [*drawings, *steps]


def lay_out_sensor(
    chip: Design,
    options: Options,
    analog: Path | None,
    out: Path,
    note: Callable[[str], None],
    sensor: SensorParameters = STANDARD,
    wrapper: Path | None = None,
) -> tuple[Path, list[str]]:
    """Lay out the chip and the die around it: (path of summary.json, limits broken).

    What needs no more of the chip than there is runs beside it. analog: folder of a user's blocks. wrapper: a shuttle's
    empty wrapper, for a die without pads. out: folder of all designs. Raises ParameterError, StepError for
    a chip that breaks a limit.
    """
    top_metal(options.pdk)  # a process without one is refused before anything runs
    if not analog:
        check_drawable(sensor)
        tile_geometries(options.pdk, sensor.tile)
    if wrapper:
        check_wrapper(wrapper, options.pdk)
    folder = out / "-".join([folder_name(replace(chip, name=SENSOR), options.pdk), *([WRAPPED] if wrapper else [])])
    blocks = files(folder / "black_boxes", options.pdk, analog, sensor)
    paths = blocks.paths | ({"wrapper": wrapper} if wrapper else {})
    runner = Runner(folder / "steps", paths, note, out / "shared")
    given = [f"timing.{corner}" for corner in options.corners] + [f"foundry.{name}" for name, _ in options.decks]
    sources = PARTS | {name: name for name in given}

    def parts(core: Runner) -> dict[str, Path]:
        """Those of the chip that there are."""
        return {name: core.paths[source] for name, source in sources.items() if source in core.paths}

    def beside(core: Runner) -> AbstractContextManager[None]:
        steps = die_steps(chip, options, blocks.drawn, sensor=sensor, wrapped=bool(wrapper))
        return runner.beside(steps, lambda: parts(core))

    core, summary = lay_out(chip, options, out, lambda text: note(f"{CHIP}: {text}"), beside)
    if wrong := broken(summary):
        raise StepError(f"{SENSOR}: its block {CHIP} breaks a limit: {wrong[0]}")
    runner.paths |= parts(core)
    return lay_out_die(chip, options, runner, drawn=blocks.drawn, sensor=sensor)


def lay_out_die(
    chip: Design,
    options: Options,
    runner: Runner,
    black_boxes: Sequence[str] = (),
    drawn: Sequence[str] = (),
    die: DieParameters | None = None,
    sensor: SensorParameters = STANDARD,
) -> tuple[Path, list[str]]:
    """Lay out the die around a chip that is laid out: (path of summary.json, limits broken).

    runner: its files are PARTS of the chip, those of the blocks, and 'wrapper' for a die in one; the results are in
    the folder above its own.
    """
    folder, wrapped = runner.folder.parent, "wrapper" in runner.paths
    runner.run_all(die_steps(chip, options, drawn, die, sensor, wrapped))
    summary = summarize(SENSOR, options, runner, black_boxes)
    lines, tech = broken(summary, RULES), layout_platform(options.pdk)
    tech = replace(tech, metals=(*tech.metals, top_metal(options.pdk).metal))
    results = RESULTS | {f"{corner}.sta.txt": f"die_sta_{corner}.report" for corner in options.corners}
    plan = json.loads(runner.paths["die_plan.plan"].read_text(encoding="utf-8"))
    others = [SHUTTLE] if wrapped else PACKAGE
    with staged(folder, [*(f"{SENSOR}.{suffix}" for suffix in results), PINS, *others]) as part:
        for suffix, source in results.items():
            if source in runner.paths:
                shutil.copyfile(runner.paths[source], part / f"{SENSOR}.{suffix}")
        blocks = part / f"{SENSOR}.blocks.png"
        by_block(blocks, plan, black_boxes)
        if wrapped:
            shuttle_files(runner, options, plan["cell"], part)
        else:
            pin_map(runner, options, plan, part)
        layout = render(runner.paths["die_gds.gds"], tech)
        layout.image.save(part / f"{SENSOR}.png")
        shown = [picture(blocks, "Blocks; hatched: black box, no circuit" if black_boxes else "Blocks")]
        if not wrapped:
            shown.append(picture(part / PACKAGE[0], "Package and bond wires, to scale"))
        write_report(part, folder, summary, lines, layout, shown)
    return folder / "summary.json", lines


def shuttle_files(runner: Runner, options: Options, cell: str, part: Path) -> None:
    """Write the pin map, and in SHUTTLE the files that the shuttle's repository takes. cell: of the wrapper."""
    shutil.copyfile(runner.paths["die_plan.pins"], part / PINS)
    for place, source in {"gds/{}.gds": "die_gds.gds", "verilog/gl/{}.v": "die_plan.verilog"}.items():
        path = part / SHUTTLE / place.format(cell)
        path.parent.mkdir(parents=True)
        shutil.copyfile(runner.paths[source], path)
    for name, text in wrappers(options.pdk)[cell].files.items():
        path = part / SHUTTLE / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")


def pin_map(runner: Runner, options: Options, plan: Mapping[str, Any], part: Path) -> None:
    """Write PINS and PACKAGE, the drawing of the package. Raises StepError for bond wires that cross."""
    process, pixel = pad_process(options.pdk), pixel_process(options.pdk)
    chosen, leads = package.packaged(plan)
    if crossed := package.crossings(leads):
        raise StepError(f"package: the bond wires of {' and '.join(crossed[0])} cross")
    volt = {lead.signal: package.volts(lead, process, pixel.supply_v, pixel.gate_v) for lead in leads}
    cells = (*process.signals.values(), *process.supplies.values())
    clamps = package.protection(runner.paths["die_pads.spice"].read_text(encoding="utf-8"), cells)
    (part / PINS).write_text(package.table(chosen, leads, volt, clamps), encoding="utf-8")
    package.draw([part / name for name in PACKAGE], chosen, leads)
