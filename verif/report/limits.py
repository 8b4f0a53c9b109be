"""limits.json: the floor (or ceiling) of every figure, and which figures fall beyond it.

A block may not have a figure at all (coverage of state machines where there is none): {"none": "the reason"}.
"""

import json
from pathlib import Path

from models.parameters import ParameterError

from .merge import figures, is_rtl, totals

FILE = Path(__file__).parent / "limits.json"
EVERY, RTL, TOTAL = "every block", "rtl", "total"
SIDES = "min", "max"
NONE = "none"


def read(path=FILE):
    """The limits: dict group or block -> figure -> {min or max: number, or none: reason}. Raises ParameterError."""
    try:
        limits = json.loads(Path(path).read_text())
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


def of_block(limits, block):
    """What holds for a block: dict figure -> sides. Its own go before those of its group."""
    groups = [limits.get(EVERY, {}), limits.get(RTL, {}) if is_rtl(block) else {}, limits.get(block, {})]
    found = {}
    for group in groups:
        for figure, sides in group.items():
            found[figure] = found.get(figure, {}) | sides
    return found


def fallen(summary, limits):
    """Figures beyond their limits, and limits of blocks or figures that are not there: list of one-line texts."""
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


def check(block, found, wanted):
    """Figures of ``found`` beyond ``wanted`` (figure -> sides): generator of one-line texts."""
    for figure, sides in wanted.items():
        value = found.get(figure)
        if value is None and NONE in sides:
            continue
        if value is None:
            yield f"{block}.{figure} = not measured: limit {limit_text(sides)}"
        elif value < sides.get("min", value) or value > sides.get("max", value):
            yield f"{block}.{figure} = {number_text(value)}: limit {limit_text(sides)}"


def limit_text(sides):
    """'at least 100', or the reason why there is no such figure."""
    held = [
        f"{'at least' if side == 'min' else 'at most'} {number_text(sides[side])}" for side in SIDES if side in sides
    ]
    return " and ".join(held) or sides[NONE]


def number_text(value):
    """Two places, but for whole numbers."""
    return f"{value:.2f}" if isinstance(value, float) and not value.is_integer() else f"{value:.0f}"
