"""`python -m flow.openroad DESIGN`: the scripts of OpenROAD's flows in build/layout/<design>-openroad/, and a run."""

import argparse
import json
import sys
from pathlib import Path

from flow.files import check_folder
from flow.layout.design import DESIGNS, design
from flow.platforms.openroad import process
from flow.simulate.process import ToolError
from models.parameters import ParameterError
from talbot.progress import Steps

from .stages import INSTALL, missing_tools, pdk_root, run, stages
from .summary import broken, summarize
from .write import ROOT, write


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
        chosen, known = design(options.design), process(options.pdk)
        folder = options.out / f"{chosen.name}-openroad"
        check_folder("out", folder)
        written = write(chosen, known, folder)
        if options.write_only:
            print(f"{folder}: {', '.join(written)}")
            return 0
        if missing_tools():
            raise ToolError(f"{', '.join(missing_tools())}: not found; get it from {INSTALL}; written: {folder}: "
                            + ", ".join(written))
        root = pdk_root(known)
        with Steps([stage.log.removesuffix(".log") for stage in stages(chosen.top)]) as bar:
            found = run(folder, chosen.top, known, root, bar.note)
        summary = summarize(chosen, known, found, folder)
        (folder / "summary.json").write_text(json.dumps(summary, indent=1) + "\n")
    except (ParameterError, ToolError, OSError) as error:
        print(f"flow.openroad: {error}", file=sys.stderr)
        return 2
    for line in broken(summary):
        print(f"flow.openroad: {chosen.name}: {line}", file=sys.stderr)
    print(folder / "summary.json")
    return 1 if broken(summary) else 0


if __name__ == "__main__":
    sys.exit(main())
