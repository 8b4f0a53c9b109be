"""Liberty as a tree: groups with attributes, and groups in them."""

from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Scalar: TypeAlias = str | float  # a bool is a number
Table: TypeAlias = list[float] | list[list[float]] | npt.NDArray[np.float64]
Value: TypeAlias = Scalar | tuple[Scalar, ...] | list[tuple[Scalar, ...]] | Table


@dataclass
class Group:
    """A group ``kind (arguments) { attributes; groups }``.

    An attribute is a text, number or bool; a tuple where Liberty has parentheses, a list of tuples where such an
    attribute is repeated; a list or array where it is an axis (index_1, index_2) or a table (values).
    """

    kind: str
    arguments: tuple[str, ...] = ()
    attributes: dict[str, Value] = field(default_factory=dict)
    groups: "list[Group]" = field(default_factory=list)

    def add(self, kind: str, *arguments: str, **attributes: Value) -> "Group":
        """Add a group to this one and return it."""
        group = Group(kind, arguments, attributes)
        self.groups.append(group)
        return group

    def all(self, kind: str, **wanted: Value) -> "list[Group]":
        """Return the groups of ``kind`` in this one whose attributes equal ``wanted``."""
        return [g for g in self.groups if g.kind == kind and all(g.attributes.get(k) == v for k, v in wanted.items())]

    def one(self, kind: str, *arguments: str) -> "Group | None":
        """Return the first group of ``kind`` whose arguments begin with ``arguments``."""
        return next((g for g in self.groups if g.kind == kind and g.arguments[: len(arguments)] == arguments), None)

    @property
    def name(self) -> str:
        """The first argument, '' where there is none."""
        return self.arguments[0] if self.arguments else ""

    def text(self, name: str) -> str:
        """Attribute ``name`` as text, '' where it is missing."""
        return str(self.attributes.get(name, ""))

    def number(self, name: str, default: float = np.nan) -> float:
        """Attribute ``name`` as a number, ``default`` where it is missing."""
        value = self.attributes.get(name, default)
        return float(value) if isinstance(value, str | int | float) else default

    def array(self, name: str) -> npt.NDArray[np.float64]:
        """Attribute ``name`` (index_1, index_2 or values) as an array. Raises KeyError where it is missing."""
        return np.asarray(self.attributes[name], dtype=float)
