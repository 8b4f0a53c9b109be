"""Lay out one design: all steps, the results under the design's name, the report."""

import json
import shutil
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Any

from talbot.base.files import staged
from talbot.base.page import Picture
from talbot.base.steps import Runner
from talbot.flow.layout.chain import input_files, scripts_of
from talbot.flow.layout.design import Design, folder_name
from talbot.flow.layout.options import Options
from talbot.flow.layout.power.energy import blocks
from talbot.flow.layout.report.metrics import broken, summarize
from talbot.flow.layout.report.page import picture, write_report
from talbot.flow.layout.report.picture import LayoutPicture, by_block, clock_tree, congestion, render
from talbot.flow.layout.search import lay_out_smallest
from talbot.platforms.layout import layout_platform
from talbot.platforms.wires import wire_corner
from talbot.signoff.netlist.netlist import Netlist

RESULTS = {
    "gds": "fill.gds",
    "v": "stream_out.verilog_with_diodes",
    "lef": "lef.lef",
    "spef": "extraction.typ",
    "sdc": "sdc",
}
RESULTS |= {"drc.lyrdb": "drc.report", "foundry.lyrdb": "foundry_drc.report", "magic_drc.txt": "magic_drc.report"}
RESULTS |= {"lvsdb": "lvs.report"}
BY_CORNER = {"sdf": "sta_{}.sdf", "sta.txt": "sta_{}.report", "lib": "block_liberty_{}.liberty"}
BY_CORNER |= {"power.json": "power_{}.instances", "ir_drop.png": "ir_drop_{}.picture"}
# Suffix and caption of the pictures next to that of the layout
PICTURES = {"blocks.png": "Cells by block", "clock.png": "Clock tree", "congestion.png": "Congestion: share of metal"}
SCRIPTS = "openroad"  # folder of the stages' scripts and their inputs, for a user's own OpenROAD
FIRST = "sdf", "lib"  # of the first corner, also under the design's name alone


def lay_out(
    design: Design,
    options: Options,
    out: Path,
    note: Callable[[str], None],
    beside: Callable[[Runner], AbstractContextManager[None]] = lambda runner: nullcontext(),
) -> tuple[Runner, dict[str, Any]]:
    """Lay out ``design`` in its folder in ``out``: (its Runner, its summary).

    beside: what goes on meanwhile, of the design's Runner. Raises ToolError, StepError.
    """
    folder = out / folder_name(design, options.pdk)
    files = input_files(design, options, folder)
    runner = Runner(folder / "steps", files, note, out / "shared")
    with beside(runner):
        summary = summarize(design, options, runner, lay_out_smallest(design, options, runner))
        publish(folder, design, options, runner, summary)
    return runner, summary


def publish(folder: Path, design: Design, options: Options, runner: Runner, summary: dict[str, Any]) -> None:
    """Copy the results into ``folder``, with report and summary, under the design's name."""
    name = design.name
    tech = layout_platform(options.pdk)
    results = dict(RESULTS)
    for corner in options.corners:
        results |= {f"{corner}.{suffix}": source.format(corner) for suffix, source in BY_CORNER.items()}
        results[f"{corner}.spef"] = f"extraction.{wire_corner(corner)}"
    for suffix in FIRST if options.corners else ():
        results[suffix] = BY_CORNER[suffix].format(options.corners[0])
    with staged(folder, [f"{name}.{suffix}" for suffix in (*results, "png", *PICTURES)]) as part:
        for suffix, source in results.items():  # results of an earlier run are removed where this one has none
            if source in runner.paths:
                shutil.copyfile(runner.paths[source], part / f"{name}.{suffix}")
        layout = None
        if "fill.gds" in runner.paths:
            layout = render(runner.paths["fill.gds"], tech, runner.paths["stream_out.gds"])
            layout.image.save(part / f"{name}.png")
        (part / SCRIPTS).mkdir()
        for file, text in scripts_of(design, options, summary["attempts"][-1]["asked"], runner.paths).items():
            (part / SCRIPTS / file).write_text(text, encoding="utf-8")
        write_report(part, folder, summary, broken(summary), layout, draw(part, design, runner, options, layout))


def draw(folder: Path, design: Design, runner: Runner, options: Options, layout: LayoutPicture | None) -> list[Picture]:
    """Draw the cells by block, the clock's tree and the congestion; pictures of these and of the IR drop.

    layout: as drawn; None, and no picture, without one.
    """
    first, name = options.corners[0], design.name
    if layout is None:
        return []
    keys = "stream_out.placement", "library.areas", "stream_out.plan"
    placement, areas, plan = (json.loads(runner.paths[key].read_text(encoding="utf-8")) for key in keys)
    netlist, tech = Netlist.read(runner.paths["stream_out.netlist"]), layout_platform(options.pdk)
    placed, files = placement["instances"], [folder / f"{name}.{suffix}" for suffix in PICTURES]
    by_block(files[0], netlist, placed, areas, tech, blocks(netlist), plan)
    clock_tree(files[1], netlist, placed, design.clock.port, plan)
    congestion(files[2], layout, [metal.name for metal in tech.metals[1:]])
    drawn = [picture(path, caption) for path, caption in zip(files, PICTURES.values(), strict=True)]
    if f"ir_drop_{first}.picture" in runner.paths:
        drawn.append(picture(folder / f"{name}.{first}.ir_drop.png", f"IR drop, {first}"))
    return drawn
