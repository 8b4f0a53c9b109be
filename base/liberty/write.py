"""A Liberty tree as text."""

import numpy as np

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


def text(group, depth=0):
    """``group`` as Liberty text, two spaces a level."""
    pad, inner = "  " * depth, "  " * (depth + 1)
    lines = [f"{pad}{group.kind} ({', '.join(_argument(a) for a in group.arguments)}) {{"]
    for name, value in group.attributes.items():
        for one in value if isinstance(value, list) and value and isinstance(value[0], tuple) else [value]:
            lines.append(inner + _attribute(name, one, inner))
    lines += [text(inside, depth + 1) for inside in group.groups]
    return "\n".join([*lines, pad + "}"])


def _argument(argument):
    return argument if argument.replace("_", "").replace("-", "").isalnum() else f'"{argument}"'


def _attribute(name, value, pad):
    if isinstance(value, np.ndarray) or name in ("values", "index_1", "index_2"):
        rows = np.atleast_2d(value)
        if name == "values":
            inside = f", \\\n{pad}  ".join(_numbers(row) for row in rows)
            return f"values ({inside});"
        return f"{name} ({_numbers(rows[0])});"
    if isinstance(value, tuple):
        return f"{name} ({', '.join(_plain(v) for v in value)});"
    return f"{name} : {_plain(value, name)};"


def _numbers(row):
    return '"' + ", ".join(f"{v:.7g}" for v in row) + '"'


def _plain(value, name=""):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        return f"{value:.7g}"
    return value if name in _WORDS else f'"{value}"'
