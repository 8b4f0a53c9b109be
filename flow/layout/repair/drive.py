"""What each cell can drive within a limit of slew, from its Liberty tables."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from talbot.base.liberty.group import Group

Curve = tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]  # loads (pF), ns
SIZE = re.compile(r"(\w+_x)(\d+)")  # a cell's name: what it does, and its size


@dataclass(frozen=True)
class Drives:
    """Capacitances (pF) by (cell, pin). inputs: of input pins. limits: that an output drives within the slew asked for.

    sizes: every cell's larger forms, the smallest first.
    """

    inputs: Mapping[tuple[str, str], float]
    limits: Mapping[tuple[str, str], float]
    sizes: Mapping[str, Sequence[str]]

    @classmethod
    def of(cls, liberty: Group, slew_ns: float) -> "Drives":
        """Of a library (ns, pF), input slews as slow as those of outputs may be."""
        inputs, limits = {}, {}
        cells = liberty.all("cell")
        for cell in cells:
            for pin in cell.all("pin"):
                if pin.text("direction") == "input":
                    inputs[cell.name, pin.name] = pin.number("capacitance")
                elif found := [_limit(table, slew_ns) for table in _slews(pin)]:
                    limits[cell.name, pin.name] = min(*found, pin.number("max_capacitance", np.inf))
        names = {cell.name for cell in cells}
        return cls(inputs, limits, {name: _larger(name, names) for name in names})

    def stronger(self, cell: str, pin: str, load: float) -> str | None:
        """The smallest form of ``cell`` that drives ``load`` (pF), None where there is none."""
        return next((name for name in (cell, *self.sizes[cell]) if self.limits[name, pin] >= load), None)

    def best(self, cell: str, pin: str, load: float) -> str:
        """The same, the largest form where none is strong enough."""
        return self.stronger(cell, pin, load) or [cell, *self.sizes[cell]][-1]


def _larger(name: str, names: set[str]) -> list[str]:
    match = SIZE.fullmatch(name)
    if not match:
        return []
    made = [(int(found[2]), found[0]) for found in map(SIZE.fullmatch, names) if found and found[1] == match[1]]
    return [larger for size, larger in sorted(made) if size > int(match[2])]


def _slews(pin: Group) -> list[Group]:
    kinds = "rise_transition", "fall_transition"
    return [table for arc in pin.all("timing") for kind in kinds for table in arc.all(kind)]


def _limit(table: Group, slew_ns: float) -> float:
    """The load (pF) at which the table's slew is ``slew_ns``, at most its last; 0 if none is as fast."""
    loads, row = over_loads(table, slew_ns)
    return 0.0 if row[0] > slew_ns else float(np.interp(slew_ns, row, loads))


def over_loads(table: Group, slew_ns: float) -> Curve:
    """A table (ns) at a slew of the input, over its loads."""
    slews = table.array("index_1")
    return table.array("index_2"), np.array([np.interp(slew_ns, slews, column) for column in table.array("values").T])
