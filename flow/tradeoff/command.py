"""Error against run time: a table (CSV) and a plot for each design parameter, and one page of all."""

from argparse import ArgumentParser, Namespace
from pathlib import Path

from .sweeps import SWEEPS, run_sweeps


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot tradeoff`."""
    parser.add_argument("--only", help=f"names with commas between, of {', '.join(SWEEPS)} (default: all)")
    parser.add_argument("--out", type=Path, default=Path("build/tradeoff"), help="folder for the tables and plots")


def run(options: Namespace) -> int:
    """Run the sweeps and print where their page is."""
    run_sweeps(options.out, options.only.split(",") if options.only is not None else None)
    print(f"look at {options.out / 'tradeoff.html'}")
    return 0
