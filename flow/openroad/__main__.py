"""`python -m flow.openroad DESIGN`: the scripts of OpenROAD's flows in build/layout/<design>-openroad/, and a run."""

import argparse
import json
import shutil
import sys
from pathlib import Path

from base.files import check_folder, staged
from base.progress import Steps
from base.tools import ToolError
from flow.layout.design import DESIGNS, flat_design
from models.parameters import ParameterError
from platforms.openroad import openroad_platform

from .merge import merge
from .metrics import broken, summarize
from .stages import INSTALL, missing_tools, pdk_root, run, stages
from .write import ROOT, write

RESULTS = ("lef", "v", "power.v", "spef", "sdc")  # of the names in the contract of flow.layout


def arguments():
    parser = argparse.ArgumentParser(prog="python -m flow.openroad", description=__doc__.splitlines()[0])
    parser.add_argument("design", help=f"one of {', '.join(DESIGNS)}")
    parser.add_argument("--pdk", default="sky130", help="process (%(default)s)")
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "layout", help="folder (%(default)s)")
    parser.add_argument("--write-only", action="store_true", help="write the scripts, run nothing")
    return parser


def main(argv=None):
    options = arguments().parse_args(argv)
    try:
        chosen, known = flat_design(options.design), openroad_platform(options.pdk)
        folder = options.out / f"{chosen.name}-openroad"
        check_folder("out", folder)
        written = write(chosen, known, folder)
        if options.write_only:
            print(f"{folder}: {', '.join(written)}")
            return 0
        if missing_tools():
            raise ToolError(
                f"{', '.join(missing_tools())}: not found; get it from {INSTALL}; written: {folder}: "
                + ", ".join(written)
            )
        root = pdk_root(known)
        with Steps([stage.log.removesuffix(".log") for stage in stages(chosen.top)] + ["gds"]) as bar:
            found = run(folder, chosen.top, known, root, bar.note)
            bar.note("gds")
            with staged(folder) as part:
                box = merge(
                    folder / f"{chosen.top}.def",
                    [root / known.tech_lef, root / known.cell_lef],
                    root / known.cell_gds,
                    known,
                    part / f"{chosen.name}.gds",
                )
                for suffix in RESULTS:
                    shutil.copyfile(folder / f"{chosen.top}.{suffix}", part / f"{chosen.name}.{suffix}")
                summary = summarize(chosen, known, found, folder, box)
                (part / "summary.json").write_text(json.dumps(summary, indent=1) + "\n")
    except (ParameterError, ToolError, OSError) as error:
        print(f"flow.openroad: {error}", file=sys.stderr)
        return 2
    for line in broken(summary):
        print(f"flow.openroad: {chosen.name}: {line}", file=sys.stderr)
    print(folder / "summary.json")
    return 1 if broken(summary) else 0


if __name__ == "__main__":
    sys.exit(main())
