"""A circuit as data: transistors by role, capacitors, resistors, circuits inside circuits; its SPICE text, its faults.

Sizes are um here, as the models have them (option scale); capacitors F, resistors ohm.
"""

from collections import Counter
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field, replace
from types import ModuleType
from typing import NamedTuple, Self

from talbot.models.parameters import ParameterError

GROUND = "0"


class Transistor(NamedTuple):
    """A transistor.

    role: a key of the process's ROLES.
    w, l: um.
    fingers: number in which it is drawn and modelled; 0: as the process's `instance` chooses.
    """

    name: str
    drain: str
    gate: str
    source: str
    bulk: str
    role: str
    w: float
    l: float  # noqa: E741
    fingers: int = 0

    @property
    def finger_um(self) -> float:
        """Width that its model has."""
        return round(self.w / max(1, self.fingers), 6)

    @property
    def nodes(self) -> tuple[str, str, str, str]:
        """Drain, gate, source, bulk."""
        return self.drain, self.gate, self.source, self.bulk


class Capacitor(NamedTuple):
    """A capacitor.

    value: F.
    units: number of matched cells, which decides its mismatch; 0: a parasitic.
    """

    name: str
    a: str
    b: str
    value: float
    units: int = 0


class Resistor(NamedTuple):
    """A resistor.

    value: ohm.
    drawn: the process's resistor, with its spread and temperature; else ideal.
    """

    name: str
    a: str
    b: str
    value: float
    drawn: bool = False


class Instance(NamedTuple):
    """Another circuit; nodes in the order of its ports."""

    name: str
    circuit: "Circuit"
    nodes: tuple[str, ...]


@dataclass(frozen=True)
class Circuit:
    """A subcircuit. ports: in the order of its pins. inputs: ports that must be driven from outside."""

    name: str
    ports: tuple[str, ...]
    transistors: tuple[Transistor, ...] = ()
    capacitors: tuple[Capacitor, ...] = ()
    resistors: tuple[Resistor, ...] = ()
    instances: tuple[Instance, ...] = field(default=())

    def circuits(self) -> "dict[str, Circuit]":
        """All circuits in it by name, the innermost first, this one last."""
        by_name: dict[str, Circuit] = {}
        for instance in self.instances:
            for name, inner in instance.circuit.circuits().items():
                if by_name.setdefault(name, inner) != inner:
                    raise ParameterError(f"circuit = {name}: must be one circuit, there are two of this name")
        by_name[self.name] = self
        return by_name

    def sizes(self) -> set[tuple[str, float, float]]:
        """(role, w, l) of every transistor, those of inner circuits too."""
        return {size for circuit in self.circuits().values() for size in circuit.own_sizes()}

    def own_sizes(self) -> set[tuple[str, float, float]]:
        """Return (role, w, l) of its transistors, without those of instances."""
        return {(t.role, t.finger_um, t.l) for t in self.transistors}

    def lines(self, process: ModuleType) -> list[str]:
        """Return the .subckt text of all circuits in it, without models.

        process: a module like platforms.sky130.analog. A capacitor with units is ``value * cscale``: the deck sets
        ``.param cscale=1 rscale=1``, or other factors for a corner of the capacitors and of drawn resistors.
        """
        return [line for circuit in self.circuits().values() for line in circuit.own_lines(process)]

    def own_lines(self, process: ModuleType) -> list[str]:
        """Text of its .subckt."""
        text = [f".subckt {self.name} {' '.join(self.ports)}", *self.devices(process)]
        for c in self.capacitors:
            text.append(f"C{c.name} {c.a} {c.b} {{{c.value:.6g}*{'cscale' if c.units else '1'}}}")
        for r in self.resistors:
            text.append(f"R{r.name} {r.a} {r.b} " + (f"{{{r.value:.6g}*rscale}}" if r.drawn else f"{r.value:.6g}"))
        text += [f"X{i.name} {' '.join(i.nodes)} {i.circuit.name}" for i in self.instances]
        return [*text, f".ends {self.name}"]

    def devices(self, process: ModuleType) -> list[str]:
        """Return the lines of its transistors, without those of instances."""
        return [process.instance(t.name, t.nodes, t.role, t.w, t.l, t.fingers) for t in self.transistors]

    def check(self, process: ModuleType) -> None:
        """Raise ParameterError that names the first broken device, net or size, in this circuit or an inner one."""
        for circuit in self.circuits().values():
            for fault in circuit._faults(process):
                raise ParameterError(f"circuit {circuit.name}: {fault}")

    def _faults(self, process: ModuleType) -> Iterator[str]:
        counts = Counter([*(t.name for t in self.transistors), *(i.name for i in self.instances)])
        yield from (f"devices: duplicate name {n}" for n, k in counts.items() if k > 1)
        for t in self.transistors:
            if t.role not in process.ROLES:
                yield f"device {t.name}: role = {t.role!r}: must be one of {', '.join(process.ROLES)}"
            elif not process.SHORTEST[t.role] <= t.l <= process.WIDEST:
                yield f"device {t.name}: l = {t.l:g}: must be in {process.SHORTEST[t.role]:g}..{process.WIDEST:g} um"
            elif not process.NARROWEST <= t.finger_um <= process.WIDEST:
                yield f"device {t.name}: w = {t.finger_um:g}: must be in {process.NARROWEST:g}..{process.WIDEST:g} um"
            if not all(t.nodes):
                yield f"device {t.name}: node = '': must be named"
        yield from (f"device {c.name}: value = {c.value}: must be above 0" for c in self.capacitors if not c.value > 0)
        yield from (f"device {r.name}: value = {r.value}: must be above 0" for r in self.resistors if not r.value > 0)
        for i in self.instances:
            if len(i.nodes) != len(i.circuit.ports):
                want = f"{len(i.circuit.ports)}, {i.circuit.name}'s ports"
                yield f"device {i.name}: nodes = {len(i.nodes)}: must be {want}"
        yield from self._open_nets()

    def _open_nets(self) -> Iterator[str]:
        """Nets that end nowhere: one device on it and no port, or gates alone. Transistors side by side are one."""
        ends: Counter[str] = Counter()
        driven = {*self.ports, GROUND}
        first: dict[str, str] = {}
        alone: dict[Transistor, Transistor] = {}
        for t in self.transistors:
            alone.setdefault(t._replace(name="", w=0.0, fingers=0), t)
        parts: list[tuple[str, tuple[str, ...], tuple[str, ...]]] = [
            (t.name, (t.drain, t.gate, t.source), (t.drain, t.source)) for t in alone.values()
        ]
        parts += [(c.name, (c.a, c.b), (c.a, c.b)) for c in (*self.capacitors, *self.resistors)]
        parts += [(i.name, i.nodes, i.nodes) for i in self.instances]
        for name, nodes, sources in parts:
            ends.update(nodes)
            driven.update(sources)
            for node in nodes:
                first.setdefault(node, name)
        for net, count in ends.items():
            if net not in driven:
                yield f"net {net} at device {first[net]}: must have a driver, it has gates alone"
            elif count < 2 and net not in self.ports and net != GROUND:
                yield f"net {net} at device {first[net]}: must have two ends, it has one"

    def with_capacitors(self, values: dict[str, float]) -> Self:
        """Return the same circuit with other values (F) of the capacitors named; inner circuits stay."""
        unknown = values.keys() - {c.name for c in self.capacitors}
        if unknown:
            raise ParameterError(f"capacitor = {min(unknown)}: must be one of {self.name}'s")
        return replace(self, capacitors=tuple(c._replace(value=values.get(c.name, c.value)) for c in self.capacitors))

    def replaced(self, changed: "Circuit") -> Self:
        """Return the circuit with ``changed`` instead of every circuit of that name in it."""
        inner = (
            i._replace(circuit=changed if i.circuit.name == changed.name else i.circuit.replaced(changed))
            for i in self.instances
        )
        return replace(self, instances=tuple(inner))

    def without(self, device: str) -> Self:
        """Return the circuit without one of its devices: a planted fault."""
        kinds = ("transistors", "capacitors", "resistors", "instances")
        kept = {kind: tuple(d for d in getattr(self, kind) if d.name != device) for kind in kinds}
        if all(len(kept[kind]) == len(getattr(self, kind)) for kind in kinds):
            raise ParameterError(f"device = {device}: must be one of {self.name}'s")
        return replace(self, **kept)


def gates(lines: Collection[str]) -> int:
    """Transistors in a netlist's text: lines that call a model."""
    return sum(line.startswith("X") and " w=" in line for line in lines)
