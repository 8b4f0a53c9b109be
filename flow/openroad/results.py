"""summary.json of a run, as far as these stages measure what the contract of flow.layout asks for."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from flow.layout.design import Design
from flow.layout.report.metrics import broken as breaks
from platforms.openroad import CORNERS, OpenRoadPlatform

from .stat import counted

RULES = {
    "drc_violations": {"is": 0},
    "antenna_violations": {"is": 0},
    **{f"{slack}.{corner}": {"least": 0} for slack in ("wns_ns", "whs_ns") for corner in CORNERS},
}


def summarize(
    design: Design, tech: OpenRoadPlatform, found: Mapping[str, float], folder: Path, box: tuple[float, float]
) -> dict[str, Any]:
    """The figures of a run; None for those that are not measured.

    found: figures of the stages' logs. folder: of the run. box: (width, height) in um.
    """
    by_corner = {name: {corner: found.get(f"{name}.{corner}") for corner in CORNERS} for name in ("wns_ns", "whs_ns")}
    cells, area = counted((folder / "synth.stat").read_text())
    period = design.clock.period_ns
    slack = by_corner["wns_ns"]["slow"]
    return {
        "design": design.name,
        "top": design.top,
        "backend": "openroad",
        "pdk": tech.name,
        "cells": cells,
        "cell_area_um2": area,
        "area_um2": round(box[0] * box[1], 2),
        "utilization": round(design.utilization * tech.utilization_share, 4),
        "drc_violations": found.get("drc_violations"),
        "antenna_violations": found.get("antenna_violations"),
        "lvs_match": None,
        "equivalence": None,
        "gate_tests": None,
        **by_corner,
        "f_max_mhz": round(1000 / (period - slack), 2) if slack is not None else None,
    }


def broken(summary: dict[str, Any]) -> list[str]:
    """Rules that ``summary`` breaks: lines; a figure that is missing breaks its rule."""
    return breaks(summary, RULES)
