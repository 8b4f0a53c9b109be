"""Error against run time: what a designer may turn, each a sweep -> table (CSV) and plot, and one page of all."""

import csv
import sys
from importlib import import_module
from pathlib import Path

from tqdm import tqdm

from base.charts import save
from base.files import staged
from models.parameters import check_choice

SWEEPS = ("divider", "threshold", "views", "precision", "noise")


def run(out, only=None, quick=False):
    """Run the sweeps named in ``only`` (all when None) and write their files into ``out``; returns dict of rows.

    quick: fewer points and a smaller array, for tests. Raises ParameterError for an unknown sweep.
    """
    names = SWEEPS if only is None else only
    for name in names:
        check_choice("only", name, SWEEPS)
    tables = {}
    for name in names:
        sweep = import_module(f"flow.tradeoff.{name}")
        points = sweep.points(quick)
        bar = tqdm(points, desc=f"{name:10s}", file=sys.stderr, leave=True, disable=None)
        rows = tables[name] = [row for point in bar for row in sweep.measure(point)]
        with staged(out) as folder:
            write_csv(folder / f"{name}.csv", rows)
            save(sweep.plot(rows), folder / f"{name}.png")
    with staged(out) as folder:
        (folder / "tradeoff.html").write_text(page(Path(out)))
    return tables


def write_csv(path, rows):
    """Write dicts with the same keys as a CSV with a header."""
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(rows[0]))
        writer.writeheader()
        writer.writerows({k: f"{v:.6g}" if isinstance(v, float) else v for k, v in row.items()} for row in rows)


def page(out):
    """HTML of every sweep whose files lie in ``out``: plot and what the sweep says of itself."""
    parts = []
    for name in SWEEPS:
        if (out / f"{name}.csv").exists():
            about = (import_module(f"flow.tradeoff.{name}").__doc__ or "").strip()
            parts.append(
                f'<h2>{name}</h2><p>{about}</p><img src="{name}.png" style="max-width:100%">'
                f'<p><a href="{name}.csv">{name}.csv</a></p>'
            )
    return (
        '<!DOCTYPE html><meta charset="utf-8"><title>Talbot: error against run time</title>'
        '<body style="font:15px/1.45 system-ui,sans-serif;max-width:900px;margin:2em auto">'
        f"<h1>Error against run time</h1>{''.join(parts)}</body>\n"
    )
