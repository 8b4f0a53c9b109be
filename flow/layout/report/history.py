"""The run history of a design: history.jsonl beside its summary, a line for every run that changed a figure."""

import json
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from talbot.flow.layout.report.text import as_text

# Names in summary.json; of a dict by corner the least counts, of power, its first
FIGURES = {
    "area_um2": "area, um2",
    "utilization": "utilization",
    "cells": "cells",
    "wire_um": "wire length, um",
    "f_max_mhz": "highest clock, MHz",
    "wns_ns": "setup slack, ns",
    "whs_ns": "hold slack, ns",
    "power_uw": "power, uW",
    "open_nets": "open nets",
    "drc_violations": "DRC violations",
    "antenna_violations": "antennas",
    "lvs_match": "LVS",
    "equivalence": "equivalence",
}


@dataclass(frozen=True)
class Run:
    """One run. when: UTC. figures: those of FIGURES. seconds: of all steps, also of those kept from earlier runs."""

    when: str
    figures: dict[str, Any]
    seconds: int

    @classmethod
    def read(cls, line: str) -> "Run":
        """Parse a line of the file."""
        values = json.loads(line)
        return cls(values.pop("when"), values, values.pop("seconds"))

    def line(self) -> str:
        """Line of the file."""
        return json.dumps({"when": self.when, **self.figures, "seconds": self.seconds}) + "\n"


def figures(summary: dict[str, Any]) -> dict[str, Any]:
    """FIGURES of a summary, one value a name."""

    def one(name: str, value: Any) -> Any:
        if not isinstance(value, dict):
            return value
        return next(iter(value.values()), None) if name == "power_uw" else min(value.values(), default=None)

    return {name: one(name, summary.get(name)) for name in FIGURES}


def history(path: Path, summary: dict[str, Any]) -> list[Run]:
    """Runs in the file ``path`` and this one, the newest last; a run with the figures of the one before is left out."""
    runs = []
    for line in path.read_text(encoding="utf-8", errors="replace").splitlines() if path.exists() else ():
        with suppress(ValueError, LookupError, TypeError, AttributeError):  # a line that is damaged is left out
            runs.append(Run.read(line))
    found = figures(summary)
    if not runs or runs[-1].figures != found:
        when = datetime.now(UTC).strftime("%Y-%m-%d %H:%M:%S")
        runs.append(Run(when, found, round(sum(summary["wall_s"].values()))))
    return runs


def table(runs: Sequence[Run], most: int = 12) -> tuple[list[str], list[list[tuple[str, bool]]]]:
    """Names of the columns; rows of (text, whether it differs from the run before), the newest run first."""
    rows = []
    for before, run in zip([None, *runs], runs, strict=False):
        row = [(run.when, False)]
        for name in FIGURES:
            value = run.figures.get(name)
            row.append((as_text(value, ("match", "differ")), before is not None and before.figures.get(name) != value))
        rows.append([*row, (f"{run.seconds:,}", False)])
    return ["UTC", *FIGURES.values(), "seconds"], rows[::-1][:most]
