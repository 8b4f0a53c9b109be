"""Capacitance and resistance of a process's layers at a corner, for the extraction of layouts."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from .layers import Crossing

SUBSTRATE = "substrate"  # and wells: below every layer
CORNERS: tuple[str, ...] = ("typ", "min", "max")  # of wires: nominal, least and most capacitance and resistance


@dataclass(frozen=True)
class Wires:
    """Coefficients at one corner; names are those of LEF.

    crossings: of every two layers, the lower one also SUBSTRATE or DIFFUSION. sidewalls: (aF, um): aF times length /
    (distance + um) between facing edges. ohms: of a square of each layer, and of each via and contact.
    """

    crossings: tuple[Crossing, ...]
    sidewalls: Mapping[str, tuple[float, float]]
    ohms: Mapping[str, float]


def wire_corner(corner: str) -> str:
    """The corner of wires for a ``corner`` of cells: the most for slow ones (ss...), the least for fast ones (ff...)."""
    return {"ss": "max", "ff": "min"}.get(corner[:2], "typ")


def rows(table: str) -> Iterator[tuple[list[str], list[list[float]]]]:
    """(names, groups of numbers) of each line of a ``table`` with columns separated by |."""
    for line in filter(str.strip, table.splitlines()):
        names, *groups = line.split("|")
        yield names.split(), [[float(number) for number in group.split()] for group in groups]
