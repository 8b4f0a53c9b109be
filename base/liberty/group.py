"""Liberty as a tree: groups with attributes, and groups in them."""

from dataclasses import dataclass, field

import numpy as np


@dataclass
class Group:
    """``kind (arguments) { attributes; groups }``. attributes: name -> text, number, bool, or tuple of these;

    a table is an attribute 'values' that is a NumPy array.
    """

    kind: str
    arguments: tuple = ()
    attributes: dict = field(default_factory=dict)
    groups: list = field(default_factory=list)

    def add(self, kind, *arguments, **attributes):
        """A new group in this one: Group."""
        group = Group(kind, tuple(map(str, arguments)), dict(attributes))
        self.groups.append(group)
        return group

    def all(self, kind, **wanted):
        """Groups in this one of ``kind`` whose attributes equal ``wanted``: list."""
        return [g for g in self.groups if g.kind == kind and all(g.attributes.get(k) == v for k, v in wanted.items())]

    def one(self, kind, *arguments):
        """The group of ``kind`` with these arguments, or None."""
        return next((g for g in self.groups if g.kind == kind and g.arguments[: len(arguments)] == arguments), None)

    @property
    def name(self):
        return self.arguments[0] if self.arguments else ""

    def array(self, name):
        """Attribute ``name`` as a float array: index_1, index_2 or values."""
        return np.asarray(self.attributes[name], dtype=float)
