"""What a search leaves: a table of all points, the front as sensor files, the summary with where it comes from."""

import sys
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from talbot.base.cache import digest
from talbot.base.table import markdown_table, write_csv
from talbot.base.tools import commit
from talbot.imaging.explore.search import Findings, Row, considered, dominated_share, importances
from talbot.imaging.explore.tasks import figures_of
from talbot.models.parameters import ParameterError, SensorParameters, sensor_text

PACKAGES = "numpy", "scipy", "numba", "optuna", "scikit-image"
THESIS = "thesis"


def name_of(row: Row) -> str:
    """The name of a point: of its sensor file, without .toml."""
    return THESIS if row.number < 0 else f"{row.number:04}"


def sensor_of_row(findings: Findings, row: Row) -> SensorParameters:
    """The sensor of a point. Raises ParameterError."""
    return _point(findings, row).sensor


def _point(findings: Findings, row: Row) -> Any:
    point = considered(findings.plan.task, row.values, ())
    if isinstance(point, str):
        raise ParameterError(point)
    return point


def command_of(findings: Findings, row: Row, folder: Path | str) -> str:
    """The command that simulates a point whose sensor file is in ``folder``/points."""
    words = findings.plan.task.words(_point(findings, row))
    make, command, *rest = words.split()
    return " ".join([make, command, f"SENSOR={folder}/points/{name_of(row)}.toml", *rest])


def table(findings: Findings) -> list[dict[str, Any]]:
    """A dict for each point: number, status, front, values, figures in full, and in the small scene (small_...).

    None where a figure was not computed.
    """
    names, out = figures_of(findings.plan.task), []
    thesis = [findings.thesis] if findings.thesis else []
    for row in [*thesis, *findings.rows]:
        entry: dict[str, Any] = {"point": name_of(row), "status": row.status, "front": row.front}
        values = findings.effective(row)
        entry |= {name: values.get(name) for name in findings.plan.space}
        for prefix, record in (("", row.full), ("small_", row.small)):
            figures = record["figures"] if record else {}
            entry |= {prefix + name: figures.get(name) for name in names}
        entry["seconds"] = sum(record["seconds"] for record in (row.small, row.full) if record)
        out.append(entry | {"reason": row.reason})
    return out


def write(folder: Path, findings: Findings, summary: Mapping[str, Any]) -> None:
    """Write trials.csv and points/*.toml, the front's and the thesis's, into ``folder``."""
    write_csv(folder / "trials.csv", table(findings))
    (folder / "points").mkdir()
    for row in [*findings.front, *findings.thesis_in_full]:
        text = f"# {command_of(findings, row, summary['folder'])}\n\n{sensor_text(sensor_of_row(findings, row))}"
        (folder / "points" / f"{name_of(row)}.toml").write_text(text, encoding="utf-8")


def summarize(findings: Findings, folder: Path) -> dict[str, Any]:
    """The figures of a search, for summary.json."""
    plan, task = findings.plan, findings.plan.task
    counts = {
        status: sum(row.status == status for row in findings.rows) for status in ("full", "small", "refused", "failed")
    }
    seconds = [sum(r["seconds"] for r in (row.small, row.full) if r) for row in findings.rows]
    return {
        "task": task.name,
        "about": task.about,
        "folder": str(folder),
        "trials": len(findings.rows),
        "exhausted": findings.exhausted,
        "counts": counts,
        "refused_before": findings.refused,
        "failed": {row.number: row.reason for row in findings.rows if row.status == "failed"},
        "seed": plan.seed,
        "batch": plan.batch,
        "sampler": plan.sampler,
        "multi_fidelity": plan.multi,
        "objectives": list(plan.objectives),
        "budget": [str(limit) for limit in plan.limits],
        "keys": {name: list(values) for name, values in plan.space.items()},
        "front": [_entry(findings, row, folder) for row in findings.front],
        "thesis": next((_entry(findings, row, folder) for row in findings.thesis_in_full), None),
        "free_error": task.free_error(),
        "importances": {name: importances(findings, name) for name in plan.objectives},
        "convergence": convergence(findings),
        "evaluation_s": sum(seconds),
        "provenance": provenance(findings),
    }


def _entry(findings: Findings, row: Row, folder: Path) -> dict[str, Any]:
    figures = (row.full or {})["figures"]
    return {
        "point": name_of(row),
        "values": findings.effective(row),
        "figures": figures,
        "command": command_of(findings, row, folder),
    }


def convergence(findings: Findings) -> list[dict[str, float]]:
    """As each batch ended: trials, processor seconds, and the part of a box of objectives that full points dominate.

    The box is from the best to the worst of each objective in the points of the whole search.
    """
    full, points = findings.objectives()
    if not full:
        return []
    low, high = points.min(0), points.max(0)
    numbers = np.array([row.number for row in full])
    return [
        {"trials": trials, "cpu_s": seconds, "share": dominated_share(points[numbers < trials], low, high)}
        for trials, seconds in findings.history
    ]


def shares(searches: Mapping[str, Findings]) -> dict[str, float]:
    """What the points in full of each search dominate, of the box of objectives that those of all searches span.

    Empty where no search has a point in full.
    """
    points = {name: findings.objectives()[1] for name, findings in searches.items()}
    every = np.concatenate(list(points.values()))
    if not len(every):
        return {}
    return {name: dominated_share(those, every.min(0), every.max(0)) for name, those in points.items()}


def provenance(findings: Findings) -> dict[str, Any]:
    """Where results come from: commit or version, the search's digest, the scenes' content, packages."""
    packages = {name: version(name) for name in PACKAGES}
    return {
        "talbot": version("talbot"),
        "commit": commit(),
        "search": findings.plan.digest,
        "task": digest(*findings.plan.task.content()),
        "python": sys.version.split()[0],
        "packages": packages,
    }


def lines(findings: Findings, objectives: Sequence[str]) -> str:
    """The front as a table of Markdown."""
    front = [findings.effective(row) for row in findings.front]
    names = [name for name in findings.plan.space if len({str(values.get(name)) for values in front}) > 1]
    rows = []
    for row in [*findings.thesis_in_full, *findings.front]:
        figures, values = (row.full or {})["figures"], findings.effective(row)
        written = (short(values.get(name)) for name in names)
        rows.append([name_of(row), *(f"{figures[name]:.4g}" for name in objectives), *written])
    return markdown_table(["point", *objectives, *names], rows)


def short(value: Any) -> str:
    """A value as a table has it."""
    return f"{value:.3g}" if isinstance(value, float) else "" if value is None else str(value)
