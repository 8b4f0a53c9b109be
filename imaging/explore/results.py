"""What a search leaves: a table of all points, the front as sensor files, the summary with where it comes from."""

import sys
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from talbot.base.cache import digest
from talbot.base.table import write_csv
from talbot.base.tools import commit
from talbot.imaging.explore.search import Found, Row, considered, dominated_share, importances, oriented
from talbot.imaging.explore.tasks import figures_of
from talbot.models.parameters import ParameterError, SensorParameters, sensor_text

PACKAGES = "numpy", "scipy", "numba", "optuna", "scikit-image"
THESIS = "thesis"


def name_of(row: Row) -> str:
    """The name of a point: of its sensor file, without .toml."""
    return THESIS if row.number < 0 else f"{row.number:04}"


def sensor_of_row(found: Found, row: Row) -> SensorParameters:
    """The sensor of a point. Raises ParameterError."""
    return _point(found, row).sensor


def _point(found: Found, row: Row) -> Any:
    point = considered(found.plan.task, row.values, ())
    if isinstance(point, str):
        raise ParameterError(point)
    return point


def command_of(found: Found, row: Row, folder: Path | str) -> str:
    """The command that simulates a point whose sensor file is in ``folder``/points."""
    words = found.plan.task.words(_point(found, row))
    make, command, *rest = words.split()
    return " ".join([make, command, f"SENSOR={folder}/points/{name_of(row)}.toml", *rest])


def table(found: Found) -> list[dict[str, Any]]:
    """A dict for each point: number, status, front, values, figures in full, and in the small scene (small_...).

    None where a figure was not computed.
    """
    names, out = figures_of(found.plan.task), []
    thesis = [found.thesis] if found.thesis else []
    for row in [*thesis, *found.rows]:
        entry: dict[str, Any] = {"point": name_of(row), "status": row.status, "front": row.front}
        entry |= {name: row.values.get(name) for name in found.plan.space}
        for prefix, record in (("", row.full), ("small_", row.small)):
            figures = record["figures"] if record else {}
            entry |= {prefix + name: figures.get(name) for name in names}
        entry["seconds"] = sum(record["seconds"] for record in (row.small, row.full) if record)
        out.append(entry | {"reason": row.reason})
    return out


def write(folder: Path, found: Found, summary: Mapping[str, Any]) -> None:
    """Write trials.csv and points/*.toml, the front's and the thesis's, into ``folder``."""
    write_csv(folder / "trials.csv", table(found))
    (folder / "points").mkdir()
    for row in [*found.front, *([found.thesis] if found.thesis and found.thesis.full else [])]:
        text = f"# {command_of(found, row, summary['folder'])}\n\n{sensor_text(sensor_of_row(found, row))}"
        (folder / "points" / f"{name_of(row)}.toml").write_text(text, encoding="utf-8")


def summarize(found: Found, folder: Path) -> dict[str, Any]:
    """The figures of a search, for summary.json."""
    plan, task = found.plan, found.plan.task
    counts = {
        status: sum(row.status == status for row in found.rows) for status in ("full", "small", "refused", "failed")
    }
    seconds = [sum(r["seconds"] for r in (row.small, row.full) if r) for row in found.rows]
    return {
        "task": task.name,
        "about": task.about,
        "folder": str(folder),
        "trials": len(found.rows),
        "exhausted": found.exhausted,
        "counts": counts,
        "refused_before": found.refused,
        "failed": {row.number: row.reason for row in found.rows if row.status == "failed"},
        "seed": plan.seed,
        "batch": plan.batch,
        "sampler": plan.sampler,
        "multi_fidelity": plan.multi,
        "objectives": list(plan.objectives),
        "budget": [str(limit) for limit in plan.limits],
        "keys": {name: list(values) for name, values in plan.space.items()},
        "front": [_entry(found, row, folder) for row in found.front],
        "thesis": _entry(found, found.thesis, folder) if found.thesis and found.thesis.full else None,
        "free_error": task.free_error(),
        "importances": {name: importances(found, name) for name in plan.objectives},
        "convergence": convergence(found),
        "evaluation_s": sum(seconds),
        "provenance": provenance(found),
    }


def _entry(found: Found, row: Row, folder: Path) -> dict[str, Any]:
    figures = (row.full or {})["figures"]
    return {"point": name_of(row), "values": row.values, "figures": figures, "command": command_of(found, row, folder)}


def convergence(found: Found) -> list[dict[str, float]]:
    """As each batch ended: trials, processor seconds, and the part of a box of objectives that full points dominate.

    The box is from the best to the worst of each objective in the points of the whole search.
    """
    full = [row for row in found.rows if row.full]
    if not full:
        return []
    points = oriented([row.full["figures"] for row in full if row.full], found.plan.objectives)
    low, high = points.min(0), points.max(0)
    numbers = np.array([row.number for row in full])
    return [
        {"trials": trials, "cpu_s": seconds, "share": dominated_share(points[numbers < trials], low, high)}
        for trials, seconds in found.history
    ]


def provenance(found: Found) -> dict[str, Any]:
    """Where results come from: commit or version, the search's digest, the scenes' content, packages."""
    packages = {name: version(name) for name in PACKAGES}
    return {
        "talbot": version("talbot"),
        "commit": commit(),
        "search": found.plan.digest,
        "task": digest(*found.plan.task.content()),
        "python": sys.version.split()[0],
        "packages": packages,
    }


def lines(found: Found, objectives: Sequence[str]) -> list[str]:
    """The front as a table of Markdown."""
    names = [name for name in found.plan.space if len({str(row.values[name]) for row in found.front}) > 1]
    head = ["point", *objectives, *names]
    out = [f"| {' | '.join(head)} |", f"|{'---|' * len(head)}"]
    for row in [*([found.thesis] if found.thesis and found.thesis.full else []), *found.front]:
        figures = (row.full or {})["figures"]
        cells = [name_of(row), *(f"{figures[name]:.4g}" for name in objectives)]
        cells += [short(row.values.get(name)) for name in names]
        out.append(f"| {' | '.join(cells)} |")
    return out


def short(value: Any) -> str:
    """A value as a table has it."""
    return f"{value:.3g}" if isinstance(value, float) else "" if value is None else str(value)
