"""`python -m flow.layout.sweep pareto|effort`: tables and plots in build/layout/sweep/; a killed run goes on."""

import argparse
import json
import sys
from dataclasses import asdict
from pathlib import Path

from base.charts import save
from base.files import check_folder, staged
from base.jobs import Job, run
from base.paths import ROOT
from base.steps import StepError
from base.tools import ToolError
from flow.layout.design import flat_design
from models.parameters import ParameterError

from .plots import effort_plot, pareto_plot
from .points import candidates, effort_point, variant_point

EFFORTS, VARIATIONS, UTILIZATIONS = (1, 2, 3), (0.05, 0.15, 0.3), (0.76, 0.84, 0.92)


def arguments():
    parser = argparse.ArgumentParser(prog="python -m flow.layout.sweep", description=__doc__)
    parser.add_argument("what", choices=("pareto", "effort"), help="variants of the divider; effort of the placer")
    parser.add_argument(
        "--liberty",
        type=Path,
        action="append",
        required=True,
        help="characterized cells at a corner (again for further corners)",
    )
    parser.add_argument("--only", action="append", help="of pareto: names of points, radix4_8 (again for more)")
    parser.add_argument("--design", default="quad_divider", help="of effort (%(default)s)")
    parser.add_argument(
        "--utilization",
        type=float,
        action="append",
        help=f"of effort (again for more; {', '.join(map(str, UTILIZATIONS))})",
    )
    parser.add_argument("--workers", type=int, default=1, help="layouts at a time, -1 for all cores (%(default)s)")
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "layout" / "sweep", help="folder (%(default)s)")
    return parser


def jobs(options):
    """The Jobs that were asked for. Raises ParameterError."""
    liberty = tuple(str(path.resolve()) for path in options.liberty)
    code = sorted((ROOT / "flow" / "layout").rglob("*.py"))
    inputs = (*options.liberty, *(path for path in code if "test" not in path.parts))
    if options.what == "effort":
        chosen = flat_design(options.design)
        return [
            Job(
                f"effort_{chosen.name}_{effort}_{variation:g}_{utilization:g}",
                effort_point,
                (chosen, liberty, str(options.out), effort, variation, utilization),
                inputs,
            )
            for utilization in options.utilization or UTILIZATIONS
            for effort in EFFORTS
            for variation in VARIATIONS
        ]
    found = {made.name: made for made in candidates()}
    for name in options.only or ():
        if name not in found:
            raise ParameterError(f"only = {name!r}: must be one of {', '.join(found)}")
    return [
        Job(name, variant_point, (made, liberty, str(options.out)), (*inputs, json.dumps(asdict(made))))
        for name, made in found.items()
        if not options.only or name in options.only
    ]


def main(argv=None):
    options = arguments().parse_args(argv)
    try:
        check_folder("out", options.out)
        for path in options.liberty:
            if not path.is_file():
                raise ParameterError(f"liberty = {path}: no such file")
        points = run(jobs(options), options.out / "jobs", options.what, options.workers)
        figure = (pareto_plot if options.what == "pareto" else effort_plot)(points)
        with staged(options.out) as part:
            (part / f"{options.what}.json").write_text(json.dumps(points, indent=1) + "\n")
            save(figure, part / f"{options.what}.png")
    except (ParameterError, ToolError, StepError, OSError) as error:
        print(f"flow.layout.sweep: {' '.join(str(error).split())[:400]}", file=sys.stderr)
        return 2
    print(options.out / f"{options.what}.png")
    return 0


if __name__ == "__main__":
    sys.exit(main())
