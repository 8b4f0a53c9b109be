"""Limits of limits.json: the least (or most) that every figure may be, and which figures are beyond it.

A figure that a block cannot have (coverage of state machines where it has none) is {"none": "the reason"}.
"""

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from talbot.models.parameters import ParameterError
from talbot.verif.report.merge import figures, is_rtl, totals
from talbot.verif.results import BlockResults

FILE = Path(__file__).parent / "limits.json"
EVERY, RTL, TOTAL = "every block", "rtl", "total"
SIDES = "min", "max"
NONE = "none"

Limits = dict[str, dict[str, dict[str, Any]]]  # group or block -> figure -> {min or max: number, or none: reason}


def read(path: Path = FILE) -> Limits:
    """Return the limits of a file. Raises ParameterError."""
    try:
        limits = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise ParameterError(f"limits = {path}: {error}") from None
    for group, named in limits.items():
        for figure, sides in named.items():
            if not sides or not all(
                isinstance(v, str) if side == NONE else side in SIDES and type(v) in (int, float)
                for side, v in sides.items()
            ):
                raise ParameterError(
                    f"limits.{group}.{figure} = {sides}: must be min or max with a number, or none with a reason"
                )
    return limits


def of_block(limits: Limits, block: str) -> dict[str, dict[str, Any]]:
    """Return what holds for a block: figure -> sides. Its own limits override those of its group."""
    groups = [limits.get(EVERY, {}), limits.get(RTL, {}) if is_rtl(block) else {}, limits.get(block, {})]
    merged: dict[str, dict[str, Any]] = {}
    for group in groups:
        for figure, sides in group.items():
            merged[figure] = merged.get(figure, {}) | sides
    return merged


def fallen(summary: Mapping[str, BlockResults], limits: Limits) -> list[str]:
    """Return a line for each figure beyond its limit or not measured, and for each block with limits but no results."""
    out = []
    for block, entry in summary.items():
        out += check(block, figures(entry), of_block(limits, block))
    out += check(TOTAL, totals(summary), limits.get(TOTAL, {}))
    out += [
        f"{block} = no results: limits.json has limits for it"
        for block in limits
        if block not in (EVERY, RTL, TOTAL) and block not in summary
    ]
    return out


def check(block: str, figures: Mapping[str, float | None], limits: Mapping[str, dict[str, Any]]) -> Iterator[str]:
    """Yield a line for each figure of ``figures`` beyond ``limits`` (figure -> sides)."""
    for figure, sides in limits.items():
        value = figures.get(figure)
        if value is None and NONE in sides:
            continue
        if value is None:
            yield f"{block}.{figure} = not measured: limit {limit_text(sides)}"
        elif value < sides.get("min", value) or value > sides.get("max", value):
            yield f"{block}.{figure} = {number_text(value)}: limit {limit_text(sides)}"


def limit_text(sides: Mapping[str, Any]) -> str:
    """Return 'at least 100', or the reason why the figure cannot exist."""
    held = [
        f"{'at least' if side == 'min' else 'at most'} {number_text(sides[side])}" for side in SIDES if side in sides
    ]
    return " and ".join(held) or sides[NONE]


def number_text(value: float) -> str:
    """Return a number with two decimals, whole numbers with none."""
    return f"{value:.2f}" if isinstance(value, float) and not value.is_integer() else f"{value:.0f}"
