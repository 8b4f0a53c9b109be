"""Capacitance and resistance of a process's layers at a corner, for the extraction of layouts."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from talbot.platforms.layers import Crossing

SUBSTRATE = "substrate"  # and wells: below every layer
CORNERS: tuple[str, ...] = ("typ", "min", "max")  # of wires: nominal, least and most capacitance and resistance


@dataclass(frozen=True)
class Wires:
    """Coefficients at one corner; names are those of LEF.

    crossings: of every two layers, the lower one also SUBSTRATE or DIFFUSION. sidewalls: (aF, um): aF times length /
    (distance + um) between facing edges. ohms: of a square of each layer, and of each via and contact. rate: /um, by
    aF/um2 of overlap, at which an edge's fringe field ends with distance. screening: exponent of the part of that field
    that other layers leave, by which they lessen the coupling between edges; norm: exponent with which an edge's
    fields downwards and upwards add. 0 and 1: none, as in Magic.
    """

    crossings: tuple[Crossing, ...]
    sidewalls: Mapping[str, tuple[float, float]]
    ohms: Mapping[str, float]
    rate: float = 0.02
    screening: float = 0.0
    norm: float = 1.0


def wire_corner(corner: str) -> str:
    """Return the corner of wires for one of cells: the most for slow ones (ss...), the least for fast ones (ff...)."""
    return {"ss": "max", "ff": "min"}.get(corner[:2], "typ")


def rows(table: str) -> Iterator[tuple[list[str], list[list[float]]]]:
    """(names, groups of numbers) of each line of a ``table`` with columns separated by |."""
    for line in filter(str.strip, table.splitlines()):
        names, *groups = line.split("|")
        yield names.split(), [[float(number) for number in group.split()] for group in groups]
