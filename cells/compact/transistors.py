"""Cells as transistors: complementary gates from their functions, other transistors one by one."""

from dataclasses import dataclass, field
from itertools import pairwise
from typing import Self, TypeAlias

Function: TypeAlias = "str | tuple[Function, ...]"  # a net, or ('and' or 'or', functions)


@dataclass(frozen=True)
class Switch:
    """A transistor of unit width between nets ``a`` and ``b``. kind: 'n' or 'p'."""

    kind: str
    gate: str
    a: str
    b: str


@dataclass
class Schematic:
    """The transistors of a cell.

    inputs, outputs: nets in order.
    n, p: equal numbers of switches; n[i] and p[i] start above each other.
    functions: Liberty expression of the inputs by output (or inner net of a gate); a flip-flop has 'next_state' and
        'clear'.
    storage: '', 'ff' or 'gate' (a clock gate).
    high: whether its p transistors have a high threshold: they leak a hundredth of plain ones, and are slower.
    """

    name: str
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    n: list[Switch] = field(default_factory=list)
    p: list[Switch] = field(default_factory=list)
    functions: dict[str, str] = field(default_factory=dict)
    storage: str = ""
    high: bool = False
    _nodes: int = 0

    @property
    def models(self) -> dict[str, str]:
        """SKY130's transistors by kind."""
        return {"n": "nfet_01v8", "p": "pfet_01v8_hvt" if self.high else "pfet_01v8"}

    @property
    def ports(self) -> tuple[str, ...]:
        """Inputs, outputs and supplies."""
        return (*self.inputs, *self.outputs, "vdd", "vss")

    def node(self) -> str:
        """Name a new inner net."""
        self._nodes += 1
        return f"m{self._nodes}"

    def gate(self, output: str, function: Function, fingers: int = 1) -> Self:
        """Add the gate output = not function, of ``fingers`` in parallel.

        function: a net's name, ('and', ...) or ('or', ...), nested.
        """
        self.functions[output] = f"!{self._expression(function)}"
        for k in range(fingers):
            # Every second finger the other way round, so that neighbours share the diffusion between them
            for kind, rail, out in (("n", "vss", self.n), ("p", "vdd", self.p)):
                self._network(kind, function, *(rail, output) if k % 2 else (output, rail), out)
        return self

    def _expression(self, function: Function) -> str:
        if isinstance(function, str):
            return f"({self.functions[function]})" if function in self.functions else function
        operator, *parts = function
        sign = " & " if operator == "and" else " | "
        return f"({sign.join(map(self._expression, parts))})"

    def _network(self, kind: str, function: Function, a: str, b: str, out: list[Switch]) -> None:
        if isinstance(function, str):
            out.append(Switch(kind, function, a, b))
            return
        operator, *parts = function
        if (operator == "and") == (kind == "n"):  # in series
            nets = [a, *(self.node() for _ in parts[1:]), b]
            for part, (left, right) in zip(parts, pairwise(nets), strict=True):
                self._network(kind, part, left, right, out)
        else:
            for part in parts:
                self._network(kind, part, a, b, out)

    def inverting_tristate(self, output: str, data: str, on: str, off: str, reset: str | None = None) -> Self:
        """Add output = not data while ``on`` is high and ``off``, its complement, is low; else it floats.

        reset: a net that makes the output high in the first case while it is low.
        """
        n, p = self.node(), self.node()
        self.n += [Switch("n", on, output, n), Switch("n", data, n, "vss")]
        self.p += [Switch("p", off, output, p), Switch("p", data, p, "vdd")]
        if reset:
            below = self.node()
            self.n[-1:] = [Switch("n", data, n, below), Switch("n", reset, below, "vss")]
            self.p.append(Switch("p", reset, p, "vdd"))
        return self

    def pass_gate(self, a: str, b: str, on: str, off: str) -> Self:
        """Join ``a`` and ``b`` while ``on`` is high and ``off``, its complement, is low."""
        self.n.append(Switch("n", on, a, b))
        self.p.append(Switch("p", off, a, b))
        return self
