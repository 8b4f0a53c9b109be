"""Layouts of the divider's variants: build/layout/sweep/. A killed run goes on."""

import json
from argparse import ArgumentParser, Namespace
from dataclasses import asdict
from pathlib import Path

from talbot.base.charts import save
from talbot.base.files import staged
from talbot.base.jobs import Job, worker_count
from talbot.base.jobs import run as run_jobs
from talbot.base.paths import RESULTS
from talbot.flow.layout.sweep.plots import pareto_plot
from talbot.flow.layout.sweep.points import candidates, variant_point
from talbot.models.parameters import ParameterError


def add_arguments(parser: ArgumentParser) -> None:
    """Arguments of `talbot layout-sweep`."""
    add = parser.add_argument
    cells = "characterized cells at a corner (again for further corners)"
    add("--liberty", type=Path, action="append", required=True, help=cells)
    add("--only", action="append", help="names of points, radix4_8 (again for more)")
    add("--workers", type=worker_count, default=1, help="layouts at a time, -1 for all cores")
    add("--out", type=Path, default=RESULTS / "layout" / "sweep", help="folder of the tables and plots")


def jobs(options: Namespace) -> list[Job]:
    """The Jobs of ``options``. Raises ParameterError."""
    liberty = tuple(str(path.resolve()) for path in options.liberty)
    inputs = tuple(options.liberty)
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
    points = run_jobs(jobs(options), options.out / "jobs", "layout", options.workers)
    figure = pareto_plot(points)
    with staged(options.out) as part:
        (part / "pareto.json").write_text(json.dumps(points, indent=1) + "\n", encoding="utf-8")
        save(figure, part / "pareto.png")
    print(options.out / "pareto.png")
    return 0
