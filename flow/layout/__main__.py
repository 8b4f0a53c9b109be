"""`python -m flow.layout DESIGN`: Verilog to a checked layout in build/layout/<design>/."""

import argparse
import json
import shutil
import sys
from pathlib import Path

from flow.files import staged
from flow.platforms.embedded import process
from flow.simulate.process import ToolError
from flow.steps import Runner, StepError
from models.parameters import ParameterError, check_choice
from talbot.progress import Steps

from .design import DESIGNS, design
from .embedded import Options, back, files, front, judged, layout, tries
from .picture import render
from .report import page
from .summary import broken, summarize

ROOT = Path(__file__).parents[2]
RESULTS = {"gds": "stream_out.gds", "v": "stream_out.verilog", "drc.lyrdb": "drc.report", "lvsdb": "lvs.report",
           "spef": "extraction.spef", "sdc": "sdc"}


def arguments():
    parser = argparse.ArgumentParser(prog="python -m flow.layout", description=__doc__.splitlines()[0])
    parser.add_argument("design", help=f"one of {', '.join(DESIGNS)}")
    parser.add_argument("--pdk", default="sky130", help="process (%(default)s)")
    parser.add_argument("--backend", default="coriolis", help="what places and routes: coriolis (%(default)s)")
    parser.add_argument("--utilization", type=float,
                        help="cells' area by core area where the search for the smallest begins; default: the design's")
    parser.add_argument("--liberty", type=Path, action="append", default=[],
                        help="characterized cells at a corner (again for further corners); default: measured now")
    parser.add_argument("--untimed", action="store_true", help="no timing: cells by area alone")
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "layout", help="folder (%(default)s)")
    return parser


def main(argv=None):
    options = arguments().parse_args(argv)
    try:
        chosen = design(options.design)
        check_choice("backend", options.backend, ("coriolis",))
        settings = Options(options.pdk, options.utilization or chosen.utilization, tuple(options.liberty),
                           options.untimed)
        folder = options.out / chosen.name
        steps = (*front(chosen, settings), *next(tries(chosen, settings)), *judged(chosen, settings),
                 *back(chosen, settings))
        with Steps(step.name for step in steps) as bar:
            runner = Runner(folder / "steps", files(chosen, settings, folder), bar.note, options.out / "shared")
            tried = layout(chosen, settings, runner)
        summary = summarize(chosen, settings, runner, tried)
        results = RESULTS | {f"{corner}.{suffix}": f"sta_{corner}.{output}" for corner in settings.corners
                             for suffix, output in (("sdf", "sdf"), ("sta.txt", "report"))}
        made = [f"{chosen.name}.{suffix}" for suffix in (*results, "png")]
        with staged(folder, made) as part:       # an earlier run's go where this one has none
            for suffix, source in results.items():
                if source in runner.paths:
                    shutil.copyfile(runner.paths[source], part / f"{chosen.name}.{suffix}")
            if "stream_out.gds" in runner.paths:
                render(runner.paths["stream_out.gds"], part / f"{chosen.name}.png", process(options.pdk)[0])
            picture = f"{chosen.name}.png" if (part / f"{chosen.name}.png").exists() else None
            (part / "report.html").write_text(page(summary, broken(summary), process(options.pdk)[0], picture))
            (part / "summary.json").write_text(json.dumps(summary, indent=1) + "\n")
    except (ParameterError, ToolError, StepError, OSError) as error:
        print(f"flow.layout: {error}", file=sys.stderr)
        return 2
    for line in broken(summary):
        print(f"flow.layout: {chosen.name}: {line}", file=sys.stderr)
    print(f"{folder / 'summary.json'}")
    return 1 if broken(summary) else 0


if __name__ == "__main__":
    sys.exit(main())
