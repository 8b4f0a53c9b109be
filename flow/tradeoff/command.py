"""Error against run time: a table (CSV) and a plot for each design parameter, and one page of all."""

from argparse import ArgumentParser, Namespace
from pathlib import Path

from talbot.base.jobs import worker_count

from .sweeps import SWEEPS, run_sweeps


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot tradeoff`."""
    parser.add_argument("--only", help=f"names with commas between, of {', '.join(SWEEPS)} (default: all)")
    workers = "processes, -1: all cores (default: 1, so that nothing else of the run is in the seconds measured)"
    parser.add_argument("--workers", type=worker_count, default=1, help=workers)
    parser.add_argument("--out", type=Path, default=Path("build/tradeoff"), help="folder for the tables and plots")


def run(options: Namespace) -> int:
    """Run the sweeps and print where their page is."""
    run_sweeps(options.out, options.only.split(",") if options.only is not None else None, workers=options.workers)
    print(f"look at {options.out / 'tradeoff.html'}")
    return 0
