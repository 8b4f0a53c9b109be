"""The registry of sweeps, and the run of one after the other: table, plot and a page of all."""

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Protocol

from matplotlib.figure import Figure
from tqdm import tqdm

from talbot.base.charts import save
from talbot.base.files import staged
from talbot.base.page import render
from talbot.base.table import write_csv
from talbot.models.parameters import check_choice

from . import divider, noise, precision, pupil, threshold, views


class Sweep(Protocol):
    """A module that sweeps one parameter; its docstring is its text on the page."""

    __doc__: str | None

    def points(self, quick: bool) -> Sequence[Any]:
        """The points to measure; quick: fewer of them and a smaller array, for tests."""
        ...

    def measure(self, point: Any) -> dict[str, Any]:
        """A row of the table."""
        ...

    def plot(self, rows: Sequence[dict[str, Any]]) -> Figure:
        """The plot of all rows."""
        ...


SWEEPS: dict[str, Sweep] = {
    "divider": divider,
    "threshold": threshold,
    "views": views,
    "pupil": pupil,
    "precision": precision,
    "noise": noise,
}


def measured(name: str, quick: bool = False) -> list[dict[str, Any]]:
    """The rows of a sweep."""
    points = tqdm(SWEEPS[name].points(quick), desc=f"{name:10s}", file=sys.stderr, leave=True, disable=None)
    return [SWEEPS[name].measure(point) for point in points]


def run_sweeps(out: Path, only: Sequence[str] | None = None, quick: bool = False) -> dict[str, list[dict[str, Any]]]:
    """Run the sweeps named in ``only`` (default: all) and write their files into ``out``; returns rows by sweep.

    Raises ParameterError for an unknown sweep.
    """
    names = list(SWEEPS) if only is None else only
    for name in names:
        check_choice("only", name, list(SWEEPS))
    tables = {}
    for name in names:
        sweep, rows = SWEEPS[name], measured(name, quick)
        tables[name] = rows
        with staged(out) as folder:
            write_csv(folder / f"{name}.csv", rows)
            save(sweep.plot(rows), folder / f"{name}.png")
    done = {name: sweep.__doc__ for name, sweep in SWEEPS.items() if (out / f"{name}.csv").exists()}
    with staged(out) as folder:
        (folder / "tradeoff.html").write_text(render(Path(__file__).with_name("tradeoff.html"), sweeps=done))
    return tables
