"""The scripts of OpenROAD's flows for a design in build/layout/<design>-openroad/, and their run."""

import json
import shutil
from argparse import ArgumentParser, Namespace
from pathlib import Path

from base.command import failures
from base.files import check_folder, staged
from base.paths import ROOT
from base.progress import Steps
from base.tools import ToolError
from flow.layout.design import DESIGNS, flat_design
from platforms.openroad import openroad_platform

from .merge import merge
from .results import broken, summarize
from .stages import INSTALL, missing_tools, pdk_root, stages
from .stages import run as run_stages
from .write import write

RESULTS = ("lef", "v", "power.v", "spef", "sdc")  # of the names in the contract of flow.layout


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot openroad`."""
    parser.add_argument("design", help=f"one of {', '.join(DESIGNS)}")
    parser.add_argument("--pdk", default="sky130", help="process")
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "layout", help="folder of the layouts")
    parser.add_argument("--write-only", action="store_true", help="write the scripts, run nothing")


def run(options: Namespace) -> int:
    """Write the scripts, run them and print where the figures are; 1 where a figure is beyond its limit."""
    chosen, tech = flat_design(options.design), openroad_platform(options.pdk)
    folder = options.out / f"{chosen.name}-openroad"
    check_folder("out", folder)
    written = f"{folder}: {', '.join(write(chosen, tech, folder))}"
    if options.write_only:
        print(written)
        return 0
    if missing_tools():
        raise ToolError(f"{', '.join(missing_tools())}: not found; get it from {INSTALL}; written: {written}")
    root = pdk_root(tech)
    with Steps([stage.log.removesuffix(".log") for stage in stages(chosen.top)] + ["gds"]) as bar:
        found = run_stages(folder, chosen.top, tech, root, bar.note)
        bar.note("gds")
        with staged(folder) as part:
            lefs = [root / tech.tech_lef, root / tech.cell_lef]
            gds = part / f"{chosen.name}.gds"
            box = merge(folder / f"{chosen.top}.def", lefs, root / tech.cell_gds, tech, gds)
            for suffix in RESULTS:
                shutil.copyfile(folder / f"{chosen.top}.{suffix}", part / f"{chosen.name}.{suffix}")
            summary = summarize(chosen, tech, found, folder, box)
            (part / "summary.json").write_text(json.dumps(summary, indent=1) + "\n")
    print(folder / "summary.json")
    return failures(f"{chosen.name}: {line}" for line in broken(summary))
