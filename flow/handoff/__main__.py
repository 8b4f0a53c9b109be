"""`python -m flow.handoff --design D`: build/handoff/<design>.tar.gz from a finished layout, build/layout/<design>/."""

import argparse
import sys
from pathlib import Path

from base.files import check_folder, staged
from base.paths import ROOT
from flow.layout.design import DESIGNS, design, folder_name
from models.parameters import ParameterError, check_choice
from platforms.load import PROCESSES

from .archive import archive, sha256
from .contents import Broken, contents, manifest, waived


def arguments():
    parser = argparse.ArgumentParser(prog="python -m flow.handoff", description=__doc__.splitlines()[0])
    parser.add_argument("--design", default="quad_divider", help=f"one of {', '.join(DESIGNS)} (%(default)s)")
    parser.add_argument("--pdk", default=PROCESSES[0], help=f"process, one of {', '.join(PROCESSES)} (%(default)s)")
    parser.add_argument(
        "--layouts", type=Path, default=ROOT / "build" / "layout", help="folder of the layouts (%(default)s)"
    )
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "handoff", help="folder (%(default)s)")
    return parser


def main(argv=None):
    options = arguments().parse_args(argv)
    try:
        chosen = design(options.design)
        check_choice("pdk", options.pdk, PROCESSES)
        check_folder("out", options.out)
        name = folder_name(chosen, options.pdk)
        files, substitutes = contents(chosen, options.layouts / name, waived(chosen))
        files["manifest.json"] = manifest(chosen, files, substitutes)
        with staged(options.out) as part:
            archive(part / f"{name}.tar.gz", name, files)
    except Broken as error:
        for line in str(error).splitlines():
            print(f"flow.handoff: {chosen.name}: {line}", file=sys.stderr)
        return 1
    except (ParameterError, OSError, ValueError) as error:
        print(f"flow.handoff: {error}", file=sys.stderr)
        return 2
    path = options.out / f"{name}.tar.gz"
    print(f"{path}: {len(files)} files, sha256 {sha256(path.read_bytes())}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
