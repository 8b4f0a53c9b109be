"""The sensor's die: the chip laid out first, the analog blocks' footprints, then the die's own steps."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

from base.files import staged
from base.steps import Runner, StepError
from flow.layout.block import lay_out
from flow.layout.report.metrics import broken
from flow.layout.report.page import Picture, write_report
from flow.layout.report.picture import render
from flow.layout.steps.antenna import AntennaParameters
from flow.layout.steps.drc import Drc, DrcParameters
from flow.layout.steps.sta import StaParameters
from platforms.coriolis import coriolis_platform
from platforms.die import top_metal

from . import analog as analog_module
from .antenna import DieAntenna
from .metrics import RULES, summarize
from .picture import by_block
from .sta import DieSta
from .steps import DieGds, DieGdsParameters, DieMatch, DiePlan, DiePlanParameters
from .wires import DieWires, DieWiresParameters

SENSOR, CHIP = "asp_sensor", "asp_chip"
# Of the chip's run, what the die is given
PARTS = {
    "core.lef": "lef.lef",
    "core.gds": "fill.gds",
    "core.verilog": "stream_out.verilog",
    "core.spef": "extraction.spef",
    "core.sdc": "sdc",
    "library.rules": "library.rules",
    "library.drc": "library.drc",
}
RESULTS = {
    "gds": "die_gds.gds",
    "v": "die_plan.verilog",
    "drc.lyrdb": "drc.report",
    "connectivity.json": "die_match.report",
    "wires.json": "die_wires.nets",
    "sdc": "die_wires.sdc",
}


def die_steps(chip, settings, extra=()):
    """The die's steps in order. chip: Design; settings: Options; extra: as of DiePlanParameters."""
    pdk, clock, io = settings.pdk, chip.clock, chip.io
    drc = Drc(DrcParameters(pdk))
    drc.inputs = drc.inputs | {"gds": "die_gds.gds"}
    wires = DieWiresParameters(
        pdk,
        clock.port,
        load_pf=io.load_pf,
        input_ns=io.input_delay * clock.period_ns,
        output_ns=io.output_delay * clock.period_ns,
    )
    return [
        DiePlan(DiePlanParameters(pdk, extra=extra)),
        DieGds(DieGdsParameters(pdk)),
        DieMatch(DieGdsParameters(pdk)),
        DieWires(wires),
        *(DieSta(StaParameters(chip.top, corner, clock.period_ns)) for corner in settings.corners),
        drc,
        DieAntenna(AntennaParameters(pdk)),
    ]


def lay_out_sensor(chip, settings, analog, out, note):
    """(path of summary.json, limits broken). analog: folder of a user's blocks, or None; out: folder of all designs.
    Raises ParameterError, StepError for a chip that breaks a limit."""
    top_metal(settings.pdk)  # a process without one is told before anything runs
    folder = Path(out) / SENSOR
    blocks, frames, extra = analog_module.files(folder / "frames", settings.pdk, analog)
    core, summary = lay_out(chip, settings, out, lambda text: note(f"{CHIP}: {text}"))
    if wrong := broken(summary):
        raise StepError(f"{SENSOR}: its block {CHIP} is not whole: {wrong[0]}")
    given = {name: core.paths[source] for name, source in PARTS.items()} | {
        f"timing.{corner}": core.paths[f"timing.{corner}"] for corner in settings.corners
    }
    return die(chip, settings, blocks | given, frames, extra, folder, note)


def die(chip, settings, given, frames, extra, folder, note):
    """As `lay_out_sensor`, of a chip that is laid out. given: dict name -> Path, PARTS and the blocks' files; frames:
    names of the blocks that are no circuits; extra: pins of the others that lead to the die's."""
    runner = Runner(folder / "steps", given, note)
    runner.run_all(die_steps(chip, settings, extra))
    summary = summarize(SENSOR, settings, runner, frames)
    lines, known = broken(summary, RULES), coriolis_platform(settings.pdk)
    known = replace(known, metals=(*known.metals, top_metal(settings.pdk).metal))
    results = RESULTS | {f"{corner}.sta.txt": f"die_sta_{corner}.report" for corner in settings.corners}
    with staged(folder, [f"{SENSOR}.{suffix}" for suffix in results]) as part:
        for suffix, source in results.items():
            shutil.copyfile(runner.paths[source], part / f"{SENSOR}.{suffix}")
        by_block(part / f"{SENSOR}.blocks.png", json.loads(runner.paths["die_plan.plan"].read_text()), frames)
        render(runner.paths["die_gds.gds"], part / f"{SENSOR}.png", known)
        write_report(
            part,
            folder,
            summary,
            lines,
            known,
            f"{SENSOR}.png",
            [Picture(f"{SENSOR}.blocks.png", "Blocks; hatched: black box, no circuit")],
        )
    return folder / "summary.json", lines
