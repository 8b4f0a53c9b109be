"""`python -m flow.layout DESIGN`: Verilog to a checked layout in build/layout/<design>/."""

import argparse
import sys
from pathlib import Path

from flow.simulate.process import ToolError
from flow.steps import Runner, StepError
from models.parameters import ParameterError
from talbot.progress import Steps

from .design import DESIGNS, design
from .embedded import Options, embedded, files

ROOT = Path(__file__).parents[2]


def arguments():
    parser = argparse.ArgumentParser(prog="python -m flow.layout", description=__doc__.splitlines()[0])
    parser.add_argument("design", help=f"one of {', '.join(DESIGNS)}")
    parser.add_argument("--pdk", default="sky130", help="process (%(default)s)")
    parser.add_argument("--utilization", type=float, default=0.5, help="cells' area by core area (%(default)s)")
    parser.add_argument("--to", help="stop behind this step")
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "layout", help="folder (%(default)s)")
    return parser


def main(argv=None):
    options = arguments().parse_args(argv)
    try:
        chosen = design(options.design)
        steps = embedded(chosen, Options(options.pdk, options.utilization))
        names = [step.name for step in steps]
        if options.to and options.to not in names:
            raise ParameterError(f"to = {options.to!r}: must be one of {', '.join(names)}")
        folder = options.out / chosen.name
        with Steps(names) as bar:
            runner = Runner(folder / "steps", files(chosen, options.pdk, folder), bar.note, options.out / "shared")
            for step in steps:
                record = runner.run(step)
                print(f"{step.name:14} {record['wall_s']:7.1f} s {record['peak_mib']:6} MiB  {record['metrics']}")
                if step.name == options.to:
                    break
    except (ParameterError, ToolError, StepError, OSError) as error:
        print(f"flow.layout: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
