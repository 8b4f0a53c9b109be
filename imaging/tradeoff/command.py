"""Error against run time: a table (CSV) and a plot for each design parameter, and one page of all."""

from argparse import ArgumentParser, Namespace
from pathlib import Path

from talbot.base.files import insert, marked
from talbot.base.jobs import worker_count
from talbot.base.sensor import add_sensor, sensor_asked, standard_alone
from talbot.imaging.tradeoff.sweeps import SWEEPS, lines, run_sweeps

VARIED = standard_alone("each sweep varies one field of the standard sensor")


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot tradeoff`."""
    add_sensor(parser)
    parser.add_argument("--only", help=f"names with commas between, of {', '.join(SWEEPS)} (default: all)")
    workers = "processes, -1: all cores (default: 1, so that nothing else of the run is in the seconds measured)"
    parser.add_argument("--workers", type=worker_count, default=1, help=workers)
    parser.add_argument("--out", type=Path, default=Path("build/tradeoff"), help="folder for the tables and plots")
    parser.add_argument("--document", type=Path, help="also put each table between the marks of this file, of its name")


def run(options: Namespace) -> int:
    """Run the sweeps and print where their page is."""
    sensor_asked(options, VARIED)
    only = options.only.split(",") if options.only is not None else None
    if options.document:
        for name in only or SWEEPS:
            marked(options.document, name)
    for name, rows in run_sweeps(options.out, only, workers=options.workers).items():
        if options.document:
            insert(options.document, name, lines(rows))
    print(f"look at {options.out / 'tradeoff.html'}")
    return 0
