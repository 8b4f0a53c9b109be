"""A design laid out with all its steps and the blocks in it, its results under their names."""

import json
import shutil
from dataclasses import replace

from base.files import staged
from base.steps import Runner, StepError
from platforms.coriolis import process

from .chain import files, layout
from .design import folder_name, macro_designs
from .macros import check_same, given
from .netlist.netlist import Netlist
from .power.energy import blocks
from .report import history
from .report.metrics import broken, summarize
from .report.page import page
from .report.picture import by_block, render

RESULTS = {
    "gds": "fill.gds",
    "v": "stream_out.verilog",
    "drc.lyrdb": "drc.report",
    "lvsdb": "lvs.report",
    "lef": "lef.lef",
    "spef": "extraction.spef",
    "sdc": "sdc",
    "foundry.lyrdb": "foundry_drc.report",
    "magic_drc.txt": "magic_drc.report",
}
BY_CORNER = {
    "sdf": "sta_{}.sdf",
    "sta.txt": "sta_{}.report",
    "lib": "block_liberty_{}.liberty",
    "power.json": "power_{}.instances",
    "ir_drop.png": "ir_drop_{}.picture",
}
FIRST = "sdf", "lib"  # of the first corner, also under the design's name alone


def figures(folder, name, runner, options):
    """Draw the cells by block where they are placed; (file, words) of this and of the voltage drop: list."""
    found, first = [], next(iter(options.corners), "")
    whole = "assemble" if "assemble.netlist" in runner.paths else "place_route"
    if f"{whole}.netlist" in runner.paths and f"ir_drop_{first}.picture" in runner.paths:
        placement, areas, plan = (
            json.loads(runner.paths[key].read_text())
            for key in (f"{whole}.placement", "library.areas", "floorplan.floorplan")
        )
        netlist = Netlist.read(runner.paths[f"{whole}.netlist"])
        by_block(
            folder / f"{name}.blocks.png",
            netlist,
            placement["instances"],
            areas,
            process(options.pdk)[0],
            blocks(netlist),
            plan,
        )
        found = [(f"{name}.blocks.png", "The cells by block"), (f"{name}.{first}.ir_drop.png", "Voltage drop")]
    return found


def laid_out(chosen, settings, out, note):
    """Lay out ``chosen``, and before it the blocks that are hardened in it: (Runner, summary); what came of each lies
    in its folder in ``out``. Raises StepError for a block that breaks a limit."""
    runners = {}
    for block in macro_designs(chosen):
        own = replace(settings, utilization=block.utilization)
        runners[block.name], summary = laid_out(block, own, out, lambda text, name=block.name: note(f"{name}: {text}"))
        if wrong := broken(summary):
            raise StepError(f"{chosen.name}: its block {block.name} is not whole: {wrong[0]}")
    folder = out / folder_name(chosen, settings.pdk)
    provided = files(chosen, settings, folder)
    check_same(chosen, provided["rtl"], runners)
    runner = Runner(folder / "steps", provided | given(chosen, runners, settings.corners), note, out / "shared")
    summary = summarize(chosen, settings, runner, layout(chosen, settings, runner))
    publish(folder, chosen.name, settings, runner, summary)
    return runner, summary


def publish(folder, name, settings, runner, summary):
    """Copy the results into ``folder``, with report and summary, under the design's ``name``."""
    results = RESULTS | {
        f"{corner}.{suffix}": source.format(corner)
        for corner in settings.corners
        for suffix, source in BY_CORNER.items()
    }
    for suffix in FIRST if settings.corners else ():
        results[suffix] = BY_CORNER[suffix].format(next(iter(settings.corners)))
    with staged(folder, [f"{name}.{suffix}" for suffix in (*results, "png", "blocks.png")]) as part:
        for suffix, source in results.items():  # an earlier run's go where this one has none
            if source in runner.paths:
                shutil.copyfile(runner.paths[source], part / f"{name}.{suffix}")
        if "fill.gds" in runner.paths:
            render(runner.paths["fill.gds"], part / f"{name}.png", process(settings.pdk)[0])
        pictures = figures(part, name, runner, settings)
        picture = f"{name}.png" if (part / f"{name}.png").exists() else None
        tell(part, folder, summary, broken(summary), process(settings.pdk)[0], picture, pictures)


def tell(part, folder, summary, lines, known, picture, pictures):
    """Write summary, history and page into ``part``, which will be in ``folder``. The rest is as of `report.page`."""
    runs = history.continued(folder / "history.jsonl", summary)
    (part / "history.jsonl").write_text(history.written(runs))
    (part / "report.html").write_text(page(summary, lines, known, runs, picture, pictures))
    (part / "summary.json").write_text(json.dumps(summary, indent=1) + "\n")
