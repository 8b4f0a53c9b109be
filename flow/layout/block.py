"""Lay out one design with the macros in it: all steps, the results under the design's name, the report."""

import json
import shutil
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Any

from talbot.base.files import staged
from talbot.base.page import Picture
from talbot.base.steps import Runner, StepError
from talbot.platforms.coriolis import coriolis_platform
from talbot.platforms.wires import wire_corner

from .chain import input_files
from .design import Design, folder_name, macro_designs
from .macros import check_same, macro_files
from .netlist.netlist import Netlist
from .options import Options
from .power.energy import blocks
from .report.metrics import broken, summarize
from .report.page import picture, write_report
from .report.picture import by_block, render
from .search import lay_out_smallest

RESULTS = {"gds": "fill.gds", "v": "stream_out.verilog", "lef": "lef.lef", "spef": "extraction.typ", "sdc": "sdc"}
RESULTS |= {"drc.lyrdb": "drc.report", "foundry.lyrdb": "foundry_drc.report", "magic_drc.txt": "magic_drc.report"}
RESULTS |= {"lvsdb": "lvs.report"}
BY_CORNER = {"sdf": "sta_{}.sdf", "sta.txt": "sta_{}.report", "lib": "block_liberty_{}.liberty"}
BY_CORNER |= {"power.json": "power_{}.instances", "ir_drop.png": "ir_drop_{}.picture"}
FIRST = "sdf", "lib"  # of the first corner, also under the design's name alone


def lay_out(
    design: Design,
    options: Options,
    out: Path,
    note: Callable[[str], None],
    beside: Callable[[Runner], AbstractContextManager[None]] = lambda runner: nullcontext(),
) -> tuple[Runner, dict[str, Any]]:
    """Lay out ``design``, its macros before it: (its Runner, its summary). Each has its folder in ``out``.

    beside: what goes on meanwhile, of the design's Runner. Raises StepError for a macro that breaks a limit.
    """
    runners = {}
    for macro in macro_designs(design):
        own = replace(options, utilization=macro.utilization)
        runners[macro.name], summary = lay_out(macro, own, out, lambda text, name=macro.name: note(f"{name}: {text}"))
        if wrong := broken(summary):
            raise StepError(f"{design.name}: its block {macro.name} breaks a limit: {wrong[0]}")
    folder = out / folder_name(design, options.pdk)
    files = input_files(design, options, folder)
    check_same(design, files["rtl"], runners)
    runner = Runner(folder / "steps", files | macro_files(design, runners, options.corners), note, out / "shared")
    with beside(runner):
        summary = summarize(design, options, runner, lay_out_smallest(design, options, runner))
        publish(folder, design.name, options, runner, summary)
    return runner, summary


def publish(folder: Path, name: str, options: Options, runner: Runner, summary: dict[str, Any]) -> None:
    """Copy the results into ``folder``, with report and summary, under the design's ``name``."""
    tech = coriolis_platform(options.pdk)
    results = dict(RESULTS)
    for corner in options.corners:
        results |= {f"{corner}.{suffix}": source.format(corner) for suffix, source in BY_CORNER.items()}
        results[f"{corner}.spef"] = f"extraction.{wire_corner(corner)}"
    for suffix in FIRST if options.corners else ():
        results[suffix] = BY_CORNER[suffix].format(options.corners[0])
    with staged(folder, [f"{name}.{suffix}" for suffix in (*results, "png", "blocks.png")]) as part:
        for suffix, source in results.items():  # results of an earlier run are removed where this one has none
            if source in runner.paths:
                shutil.copyfile(runner.paths[source], part / f"{name}.{suffix}")
        layout = None
        if "fill.gds" in runner.paths:
            layout = render(runner.paths["fill.gds"], tech, runner.paths["stream_out.gds"])
            layout.image.save(part / f"{name}.png")
        write_report(part, folder, summary, broken(summary), layout, draw(part, name, runner, options))


def draw(folder: Path, name: str, runner: Runner, options: Options) -> list[Picture]:
    """Draw the cells by block; pictures of this and of the IR drop, none where the layout has no power."""
    first = next(iter(options.corners), "")
    step = "assemble" if "assemble.netlist" in runner.paths else "repair"
    if f"{step}.netlist" not in runner.paths or f"ir_drop_{first}.picture" not in runner.paths:
        return []
    keys = f"{step}.placement", "library.areas", "floorplan.floorplan"
    placement, areas, plan = (json.loads(runner.paths[key].read_text(encoding="utf-8")) for key in keys)
    netlist, tech = Netlist.read(runner.paths[f"{step}.netlist"]), coriolis_platform(options.pdk)
    file = f"{name}.blocks.png"
    by_block(folder / file, netlist, placement["instances"], areas, tech, blocks(netlist), plan)
    drop = folder / f"{name}.{first}.ir_drop.png"
    return [picture(folder / file, "Cells by block"), picture(drop, f"IR drop, {first}")]
