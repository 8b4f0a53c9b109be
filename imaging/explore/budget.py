"""Limits of a search: `energy_uj<20,area_mm2<10`."""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from talbot.models.parameters import ParameterError
from talbot.models.parameters.sensor_file import nearest

TERM = re.compile(r"\s*([A-Za-z_]\w*)\s*(<=|>=|<|>)\s*(\S+?)\s*")


@dataclass(frozen=True)
class Limit:
    """One term: a figure that must be at most (or at least) ``value``."""

    name: str
    most: bool
    value: float

    def excess(self, figures: Mapping[str, float]) -> float:
        """By how much ``figures`` break it, in parts of the limit; 0 or less where they keep it, or have none."""
        if self.name not in figures:
            return 0.0
        over = figures[self.name] - self.value
        return (over if self.most else -over) / (abs(self.value) or 1.0)

    def __str__(self) -> str:
        return f"{self.name}{'<=' if self.most else '>='}{self.value:g}"


def limits_of(text: str, names: Sequence[str]) -> tuple[Limit, ...]:
    """The terms of ``text``, with commas between. names: figures that there are. Raises ParameterError."""
    out = []
    for term in text.split(",") if text.strip() else ():
        match = TERM.fullmatch(term)
        if not match:
            raise ParameterError(f"budget = {term.strip()!r}: must be a figure, <, <=, > or >=, and a number")
        name, sign, number = match.groups()
        if name not in names:
            raise ParameterError(
                f"budget = {term.strip()!r}: {name} must be a figure of the task{nearest(name, names)}"
            )
        try:
            value = float(number)
        except ValueError:
            value = float("nan")
        if not abs(value) < float("inf"):
            raise ParameterError(f"budget = {term.strip()!r}: {number} must be a finite number")
        out.append(Limit(name, sign[0] == "<", value))
    return tuple(out)


def broken(limits: Iterable[Limit], figures: Mapping[str, float]) -> str:
    """The first limit that ``figures`` break, with the figure; '' where they keep all."""
    for limit in limits:
        if limit.excess(figures) > 0:
            side = "at most" if limit.most else "at least"
            return f"{limit.name} = {figures[limit.name]:.4g}: must be {side} {limit.value:g}"
    return ""
