"""The scripts of OpenROAD's flows for a design in build/layout/<design>-openroad/, and their run."""

import json
import shutil
from argparse import ArgumentParser, Namespace
from pathlib import Path

from talbot.base.command import failures
from talbot.base.files import check_folder, staged
from talbot.base.openroad import INSTALL
from talbot.base.paths import RESULTS
from talbot.base.progress import Steps
from talbot.base.sensor import add_sensor
from talbot.base.tools import ToolError
from talbot.flow.layout.design import DESIGNS, check_flat, design_asked, folder_name
from talbot.flow.layout.varied import CHIP
from talbot.flow.openroad.results import broken, summarize
from talbot.flow.openroad.signoff import check, checks
from talbot.flow.openroad.stages import missing_tools, pdk_root, stages, wire_corners
from talbot.flow.openroad.stages import run as run_stages
from talbot.flow.openroad.write import write
from talbot.platforms.openroad import openroad_platform
from talbot.platforms.processes import PROCESSES
from talbot.signoff.geometry.merge import merge

# Suffixes of the contract of flow.layout -> file of the run, or of a check
FINAL = {"lef": "final.lef", "v": "final.v", "power.v": "final.power.v", "spef": "nom.spef", "def": "final.def"}
BY_CORNER = {"sdf": "sta_{}.sdf", "lib": "block_liberty_{}.liberty"}
CHECKED = {"gds": "fill.gds", "sdc": "sdc", "drc.lyrdb": "drc.report", "lvsdb": "lvs.report"}


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot openroad`."""
    parser.add_argument("design", nargs="?", default=CHIP, help=f"one of {', '.join(DESIGNS)}")
    add_sensor(parser)
    parser.add_argument("--pdk", default="sky130", help="process")
    parser.add_argument("--out", type=Path, default=RESULTS / "layout", help="folder of the layouts")
    parser.add_argument("--write-only", action="store_true", help="write the scripts, run nothing")


def run(options: Namespace) -> int:
    """Write the scripts, run them and print where the figures are; 1 where a figure is beyond its limit."""
    chosen, tech = design_asked(options.design, options), openroad_platform(options.pdk)
    check_flat(chosen)
    folder = options.out / f"{folder_name(chosen, PROCESSES[0])}-openroad"
    check_folder("out", folder)
    written = f"{folder}: {', '.join(write(chosen, tech, folder))}"
    if options.write_only:
        print(written)
        return 0
    if missing_tools():
        raise ToolError(f"{', '.join(missing_tools())}: not found; {INSTALL}; written: {written}")
    root = pdk_root(tech)
    names = [stage.label for stage in stages(tech, wire_corners(tech, root))]
    with Steps([*names, "gds", "library", *(step.name for step in checks(chosen, tech))], lines=True) as bar:
        found = run_stages(folder, chosen.top, tech, root, bar.note)
        bar.note("gds")
        lefs = [root / tech.tech_lef, root / tech.cell_lef]
        size = merge(folder / "final.def", lefs, root / tech.cell_gds, tech, folder / "final.gds")
        checked = check(chosen, tech, root, folder, size, bar.note)
        results = CHECKED | {
            f"{corner}.{suffix}": source.format(corner)
            for corner in tech.corners
            for suffix, source in BY_CORNER.items()
        }
        with staged(folder, [f"{chosen.name}.{suffix}" for suffix in (*FINAL, *results)]) as part:
            for suffix, file in FINAL.items():
                shutil.copyfile(folder / file, part / f"{chosen.name}.{suffix}")
            for suffix, source in results.items():
                shutil.copyfile(checked.paths[source], part / f"{chosen.name}.{suffix}")
            summary = summarize(chosen, tech, found, folder, size, checked)
            (part / "summary.json").write_text(json.dumps(summary, indent=1) + "\n", encoding="utf-8")
    print(folder / "summary.json")
    return failures(f"{chosen.name}: {line}" for line in broken(summary))
