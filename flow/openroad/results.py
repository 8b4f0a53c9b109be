"""The summary of a run: those figures of the contract of flow.layout that these stages measure."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from flow.layout.design import Design
from flow.layout.report.metrics import broken as breaks
from platforms.openroad import CORNERS, OpenRoadPlatform

from .stat import counted

RULES = {name: {"is": 0} for name in ("drc_violations", "antenna_violations")}
RULES |= {f"{slack}.{corner}": {"least": 0} for slack in ("wns_ns", "whs_ns") for corner in CORNERS}


def summarize(
    design: Design, tech: OpenRoadPlatform, found: Mapping[str, float], folder: Path, box: tuple[float, float]
) -> dict[str, Any]:
    """The figures of a run; None for those that are not measured.

    found: figures of the stages' logs. folder: of the run. box: (width, height) in um.
    """
    slacks = {name: {corner: found.get(f"{name}.{corner}") for corner in CORNERS} for name in ("wns_ns", "whs_ns")}
    cells, area = counted((folder / "synth.stat").read_text())
    slack = slacks["wns_ns"]["slow"]
    f_max = None if slack is None else round(1000 / (design.clock.period_ns - slack), 2)
    utilization = round(design.utilization * tech.utilization_share, 4)
    return (
        {"design": design.name, "top": design.top, "backend": "openroad", "pdk": tech.name}
        | {"cells": cells, "cell_area_um2": area, "area_um2": round(box[0] * box[1], 2), "utilization": utilization}
        | {name: found.get(name) for name in ("drc_violations", "antenna_violations")}
        | dict.fromkeys(("lvs_match", "equivalence", "gate_tests"))
        | {**slacks, "f_max_mhz": f_max}
    )


def broken(summary: dict[str, Any]) -> list[str]:
    """Rules that ``summary`` breaks: lines; a figure that is missing breaks its rule."""
    return breaks(summary, RULES)
