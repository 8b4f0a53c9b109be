"""The page of `import talbot`: every name that it offers, from its docstring."""

import re
from pathlib import Path
from types import ModuleType
from typing import Any

import talbot

HEAD = """# The Python API

`import talbot` offers these names and no more. What is out of range raises `ParameterError`, one line with the field,
the value and the range. In a notebook sensors, light fields, runs, images and trade-offs show themselves.

```{eval-rst}
.. py:module:: talbot
"""
FIRST = "Sensor", "LightField", "Run", "Image", "decode", "DecodedFrame", "tradeoff", "Tradeoff", "PixelType", "scenes"
# What restructuredText would read as markup, and our docstrings mean as text
MARKUP = re.compile(r"(?<!`)[*|](?!`)|_(?=\W|$)")


def write(source: Path) -> None:
    """Write api.md."""
    names = [*FIRST, *(name for name in talbot.__all__ if name not in FIRST)]
    lines = [HEAD]
    for name in names:
        value = getattr(talbot, name)
        if isinstance(value, type):
            lines.append(f".. autoclass:: talbot.{name}\n   :members:\n")
        elif isinstance(value, ModuleType):
            options = ":members:\n   :imported-members:\n"
            lines.append(f".. automodule:: {value.__name__}\n   {options}")
        elif callable(value):
            lines.append(f".. autofunction:: talbot.{name}\n")
        else:
            lines.append(f".. py:data:: {name}\n\n   {', '.join(f'`{item}`' for item in value)}\n")
    (source / "api.md").write_text("\n".join([*lines, "```", ""]), encoding="utf-8")


def as_text(app: Any, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    """For Sphinx: a docstring is prose with `code`, no other markup."""
    lines[:] = [line if line.startswith("    ") else MARKUP.sub(r"\\\g<0>", line) for line in lines]
