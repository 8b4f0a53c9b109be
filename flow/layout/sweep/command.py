"""Layouts of the divider's variants, or of a design at several efforts: build/layout/sweep/. A killed run goes on."""

import json
from argparse import ArgumentParser, Namespace
from dataclasses import asdict
from itertools import product
from pathlib import Path

from talbot.base.charts import save
from talbot.base.files import staged
from talbot.base.jobs import Job, worker_count
from talbot.base.jobs import run as run_jobs
from talbot.base.paths import RESULTS
from talbot.flow.layout.design import flat_design
from talbot.models.parameters import ParameterError

from .plots import effort_plot, pareto_plot
from .points import candidates, effort_point, variant_point

EFFORTS, SPREADS, UTILIZATIONS = (1, 3, 6), (0.5, 0.75, 1.0), (0.48, 0.54, 0.6)


def add_arguments(parser: ArgumentParser) -> None:
    """Arguments of `talbot layout-sweep`."""
    add = parser.add_argument
    add("what", choices=("pareto", "effort"), help="variants of the divider; effort of the placer")
    cells = "characterized cells at a corner (again for further corners)"
    add("--liberty", type=Path, action="append", required=True, help=cells)
    add("--only", action="append", help="of pareto: names of points, radix4_8 (again for more)")
    add("--design", default="quad_divider", help="of effort")
    utilizations = ", ".join(map(str, UTILIZATIONS))
    add("--utilization", type=float, action="append", help=f"of effort (again for more; default: {utilizations})")
    add("--workers", type=worker_count, default=1, help="layouts at a time, -1 for all cores")
    add("--out", type=Path, default=RESULTS / "layout" / "sweep", help="folder of the tables and plots")


def jobs(options: Namespace) -> list[Job]:
    """The Jobs of ``options``. Raises ParameterError."""
    liberty = tuple(str(path.resolve()) for path in options.liberty)
    inputs = tuple(options.liberty)
    if options.what == "effort":
        chosen, made = flat_design(options.design), []
        for utilization, effort, spread in product(options.utilization or UTILIZATIONS, EFFORTS, SPREADS):
            name = f"effort_{chosen.name}_{effort}_{spread:g}_{utilization:g}"
            arguments = chosen, liberty, str(options.out), effort, spread, utilization
            made.append(Job(name, effort_point, arguments, inputs))
        return made
    found = {made.name: made for made in candidates()}
    for name in options.only or ():
        if name not in found:
            raise ParameterError(f"only = {name!r}: must be one of {', '.join(found)}")
    return [
        Job(name, variant_point, (made, liberty, str(options.out)), (*inputs, json.dumps(asdict(made))))
        for name, made in found.items()
        if not options.only or name in options.only
    ]


def run(options: Namespace) -> int:
    """Lay out the points, write their table and plot, and print the plot's path."""
    for path in options.liberty:
        if not path.is_file():
            raise ParameterError(f"liberty = {path}: no such file")
    points = run_jobs(jobs(options), options.out / "jobs", options.what, options.workers)
    figure = (pareto_plot if options.what == "pareto" else effort_plot)(points)
    with staged(options.out) as part:
        (part / f"{options.what}.json").write_text(json.dumps(points, indent=1) + "\n", encoding="utf-8")
        save(figure, part / f"{options.what}.png")
    print(options.out / f"{options.what}.png")
    return 0
