"""The registry of sweeps, and the run of one after the other: table, plot and a page of all."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Protocol

from matplotlib.figure import Figure
from PIL import Image

from talbot.base.charts import save, svg
from talbot.base.files import staged
from talbot.base.jobs import Job, run
from talbot.base.page import TABLES, Section, render
from talbot.base.paths import BUILD
from talbot.base.table import read_csv, write_csv
from talbot.imaging.tradeoff import (
    depth,
    divider,
    exposure,
    fixed_pattern,
    lens,
    light,
    light_field,
    light_field_sensor,
    noise,
    polarization,
    precision,
    pupil,
    spectra,
    threshold,
    views,
)
from talbot.models.parameters import check_choice
from talbot.models.reconstruct import branches, sparse

STORE = BUILD / "tradeoff" / "measured"


class Sweep(Protocol):
    """A module that sweeps one parameter; its docstring is its text on the page."""

    __doc__: str | None

    def points(self, quick: bool) -> Sequence[Any]:
        """Return the points to measure; quick: fewer of them and a smaller array, for tests."""
        ...

    def measure(self, point: Any) -> dict[str, Any]:
        """Return a row of the table."""
        ...

    def plot(self, rows: Sequence[dict[str, Any]]) -> Figure:
        """Return the plot of all rows."""
        ...


SWEEPS: dict[str, Sweep] = {
    "divider": divider,
    "threshold": threshold,
    "fixed_pattern": fixed_pattern,
    "exposure": exposure,
    "light": light,
    "lens": lens,
    "views": views,
    "pupil": pupil,
    "precision": precision,
    "noise": noise,
    "light_field": light_field,
    "light_field_sensor": light_field_sensor,
    "depth": depth,
    "polarization": polarization,
    "spectra": spectra,
}


def measured(name: str, quick: bool = False, workers: int = 1, store: Path = STORE) -> list[dict[str, Any]]:
    """Return the rows of a sweep, each kept in ``store``: a run that was killed goes on from there."""
    call, learned = SWEEPS[name].measure, (branches.WEIGHTS, sparse.DICTIONARY)
    points = enumerate(SWEEPS[name].points(quick))
    return run([Job(f"{name}_{n}", call, (p,), (repr(p), *learned)) for n, p in points], store, name, workers)


def run_sweeps(
    out: Path, only: Sequence[str] | None = None, quick: bool = False, workers: int = 1, store: Path = STORE
) -> dict[str, list[dict[str, Any]]]:
    """Run the sweeps named in ``only`` (default: all) and write their files into ``out``; returns rows by sweep.

    workers: processes; with one, nothing of the run itself is in the seconds that are measured. The page shows every
    sweep whose table is there. Raises ParameterError for an unknown sweep.
    """
    names = list(SWEEPS) if only is None else only
    for name in names:
        check_choice("only", name, list(SWEEPS))
    tables = {}
    for name in names:
        rows = tables[name] = measured(name, quick, workers, store)
        with staged(out) as folder:
            write_csv(folder / f"{name}.csv", rows)
            save(SWEEPS[name].plot(rows), folder / f"{name}.png")
    done = [name for name in SWEEPS if (out / f"{name}.csv").exists()]
    with staged(out) as folder:
        (folder / "tradeoff.html").write_text(_page(out, done), encoding="utf-8")
    return tables


def lines(rows: Sequence[dict[str, Any]]) -> str:
    """Return ``rows`` as a table in Markdown, numbers to three digits."""
    cells = [[f"{v:.3g}" if isinstance(v, float) else str(v) for v in row.values()] for row in rows]
    heads = [[name.replace("_", " ") for name in rows[0]], ["---:"] * len(rows[0])]
    return "".join(f"| {' | '.join(row)} |\n" for row in (*heads, *cells))


def _page(out: Path, done: Sequence[str]) -> str:
    """Return the page of the sweeps in ``out``."""
    sections = []
    for name in done:
        rows, about = read_csv(out / f"{name}.csv"), " ".join((SWEEPS[name].__doc__ or "").split())
        cells = [list(map(str, row.values())) for row in rows]
        sections.append(
            Section(name.capitalize(), about, [svg(SWEEPS[name].plot(rows))], head=list(rows[0]), rows=cells)
        )
    with Image.open(out / f"{done[0]}.png") as picture:
        about = f"{', '.join(done)}; each with its table, also as <name>.csv; a label is left out where it has no place"
        return render(TABLES, "Error against run time", picture=picture, about=about, sections=sections)
