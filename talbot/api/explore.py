"""Which sensor for a task: the search of `make explore`, its table and its sensors."""

import importlib
import importlib.util
from argparse import Namespace
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from talbot.api.image import text
from talbot.api.sensor import Sensor
from talbot.imaging.explore.command import NUMBERS, explored, folder_and_plan
from talbot.imaging.explore.results import name_of, sensor_of_row, table
from talbot.imaging.explore.search import Findings
from talbot.models.parameters import check_choice


@dataclass(frozen=True, eq=False, repr=False)
class Exploration:
    """A search that ended. summary: the figures, as in summary.json. folder: of the page and the sensor files.

    findings: all of it (`talbot.imaging.explore.search.Findings`).
    """

    findings: Findings
    summary: dict[str, Any]
    folder: Path

    @property
    def table(self) -> Any:
        """Every point with its values and figures: a pandas.DataFrame, or a list of dicts where pandas is missing."""
        rows = table(self.findings)
        if importlib.util.find_spec("pandas") is None:
            return rows
        return importlib.import_module("pandas").DataFrame(rows)

    @property
    def front(self) -> list[str]:
        """Names of the points on the front."""
        return [name_of(row) for row in self.findings.front]

    def sensor(self, point: str) -> Sensor:
        """The sensor of a point, by its name; 'thesis' is the thesis's. Raises ParameterError."""
        thesis = [self.findings.thesis] if self.findings.thesis else []
        rows = {name_of(row): row for row in [*thesis, *self.findings.rows]}
        check_choice("point", point, list(rows))
        return Sensor.of(sensor_of_row(self.findings, rows[point]))

    def __repr__(self) -> str:
        s = self.summary
        return f"<Exploration of {s['task']}: {s['trials']} points, {len(s['front'])} on the front, in {self.folder}>"

    def _repr_html_(self) -> str:
        names = self.summary["objectives"]
        rows = [[entry["point"], *(entry["figures"][name] for name in names)] for entry in self.summary["front"]]
        lines = [("th", ["point", *names]), *(("td", row) for row in rows)]
        body = "".join(f"<tr>{''.join(f'<{tag}>{text(v)}</{tag}>' for v in row)}</tr>" for tag, row in lines)
        return f"<p>{text(self.summary['about'])}</p><table>{body}</table>"


def explore(
    task: str | Path = "edges",
    *,
    out: str | Path | None = None,
    scenes: str = "",
    budget: str = "",
    objectives: str = "",
    keys: str = "",
    sampler: str = "tpe",
    full: bool = False,
    no_thesis: bool = False,
    baseline: bool = False,
    sensor: Sensor | None = None,
    workers: int = 1,
    **numbers: float,
) -> Exploration:
    """Search the sensors for a task, as `make explore` does; a search that ended early continues.

        exploration = talbot.explore("edges", budget="energy_uj<20", trials=40, seed=1)
        exploration.table                        # every point, with values and figures
        exploration.sensor(exploration.front[0]).save("mine.toml")

    task: edges, lightfield, polarization, depth, recognition, or a file .py (imaging/explore/README.md). out: folder,
    build/explore/<task> without one. scenes, budget, objectives, keys, sampler, full, no_thesis, baseline, workers: as
    of the command. sensor: of keys that do not vary. numbers: lux, trials, seed, batch, timeout, robust.

    Raises ParameterError.
    """
    options = Namespace(task=str(task), scenes=scenes, budget=budget, objectives=objectives, keys=keys, sampler=sampler)
    options.full, options.no_thesis, options.workers, options.sensor = full, no_thesis, workers, None
    options.out = Path(out) if out else None
    for name in numbers:
        check_choice("number", name, [number.field for number in NUMBERS])
    for number in NUMBERS:
        setattr(options, number.field, str(numbers.get(number.field, number.default)))
    folder, plan, robust = folder_and_plan(options, sensor.parameters if sensor else None)
    findings, summary = explored(plan, folder, robust, baseline)
    return Exploration(findings, summary, folder)
