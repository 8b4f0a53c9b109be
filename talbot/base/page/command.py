"""The page over a folder of results: index.html, with a card for each page below it."""

from argparse import ArgumentParser, Namespace
from pathlib import Path

from talbot.base.page import index
from talbot.base.paths import RESULTS
from talbot.models.parameters import ParameterError


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot index`."""
    parser.add_argument("--out", type=Path, default=RESULTS, help="folder of the results")


def run(options: Namespace) -> int:
    """Write the page and print its path."""
    if not options.out.is_dir():
        raise ParameterError(f"out = {str(options.out)!r}: must be a folder of results")
    print(index.refresh(options.out))
    return 0
