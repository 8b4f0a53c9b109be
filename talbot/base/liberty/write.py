"""A Liberty tree as text."""

from collections.abc import Iterable

import numpy as np

from talbot.base.liberty.group import Group, Scalar, Value

# Attributes whose values are bare words in Liberty, not texts in quotes
_WORDS = {
    "direction",
    "timing_type",
    "timing_sense",
    "pg_type",
    "delay_model",
    "type",
    "variable_1",
    "variable_2",
    "in_place_swap_mode",
    "clear_preset_var1",
    "clear_preset_var2",
    "clock_gating_integrated_cell",
    "default_operating_conditions",
    "tree_type",
}


def text(group: Group) -> str:
    """``group`` as Liberty text, two spaces a level."""
    return "\n".join([*_lines(group, ""), ""])


def _lines(group: Group, pad: str) -> Iterable[str]:
    inner = pad + "  "
    yield f"{pad}{group.kind} ({', '.join(_argument(a) for a in group.arguments)}) {{"
    for name, value in group.attributes.items():
        repeated = [one for one in value if isinstance(one, tuple)] if isinstance(value, list) else []
        for one in repeated or [value]:
            yield inner + _attribute(name, one, inner)
    for inside in group.groups:
        yield from _lines(inside, inner)
    yield pad + "}"


def _argument(argument: str) -> str:
    return argument if argument.replace("_", "").replace("-", "").isalnum() else f'"{argument}"'


def _attribute(name: str, value: Value, pad: str) -> str:
    if isinstance(value, tuple):
        return f"{name} ({', '.join(_plain(v) for v in value)});"
    if isinstance(value, list | np.ndarray):
        rows = [_numbers(row) for row in np.atleast_2d(np.asarray(value, dtype=float))]
        inside = f", \\\n{pad}  ".join(rows)
        return f"{name} ({inside});"
    return f"{name} : {_plain(value, name)};"


def _numbers(row: Iterable[float]) -> str:
    return '"' + ", ".join(f"{v:.7g}" for v in row) + '"'


def _plain(value: Scalar, name: str = "") -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        return f"{value:.7g}"
    return value if name in _WORDS else f'"{value}"'
