"""OpenSTA's SDF for Icarus 11, which annotates the path delays of cells and no more.

Measured with Icarus 11.0: IOPATH is annotated when all three values of a triple are present (OpenSTA leaves the
typical one out, and a path then has no delay, with no message); INTERCONNECT is a syntax error; checks of setup and
hold are not made. So a net's delay is added to that of the cell that drives it, the largest of its branches (that of an
input port's net is left out), and setup and hold are modules of the bench (replay.py), each with the later time of
both edges.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from talbot.signoff.netlist.netlist import Instance, Netlist

TOKEN = re.compile(r'\(|\)|"[^"]*"|[^\s()]+')


class Arc(NamedTuple):
    """Delays from a cell's input to its output, ns."""

    source: str
    target: str
    rise: float
    fall: float


class Check(NamedTuple):
    """Setup and hold of a register's pin, ns."""

    instance: Instance
    pin: str
    setup: float
    hold: float


@dataclass(frozen=True)
class Delays:
    """Delays of a netlist, ns.

    paths: by instance. nets: (instance or None for a port, pin or port) that drives -> (rise, fall) of the slowest
    branch. checks: instance -> pin -> [setup, hold].
    """

    paths: dict[str | None, list[Arc]]
    nets: dict[tuple[str | None, str], tuple[float, float]]
    checks: dict[str | None, dict[str, list[float]]]


def read(text: str) -> Delays:
    """Delays of an SDF file as OpenSTA writes it; the later value of each triple (for hold too)."""
    tokens = TOKEN.findall(text)
    found = Delays({}, {}, {})
    for cell in _groups(_tree(iter(tokens[1:])), "CELL"):
        name = next((_plain(part[1]) for part in cell if part[0] == "INSTANCE" and len(part) > 1), None)
        for absolute in (x for delay in _groups(cell, "DELAY") for x in _groups(delay, "ABSOLUTE")):
            for _, source, target, *values in _groups(absolute, "IOPATH"):
                found.paths.setdefault(name, []).append(Arc(source, target, *_both(values)))
            for _, source, _, *values in _groups(absolute, "INTERCONNECT"):
                instance, _, pin = source.rpartition("/")
                end = _plain(instance) if instance else None, _plain(pin)
                (rise, fall), before = _both(values), found.nets.get(end, (0.0, 0.0))
                found.nets[end] = max(before[0], rise), max(before[1], fall)
        for group in _groups(cell, "TIMINGCHECK"):
            for k, kind in enumerate(("SETUP", "HOLD")):
                for _, data, _, value in _groups(group, kind):
                    worst = found.checks.setdefault(name, {}).setdefault(data[-1], [-1e9, -1e9])
                    worst[k] = max(worst[k], _late(value))
    return replace(found, paths={name: _slowest(arcs) for name, arcs in found.paths.items()})


def _slowest(arcs: list[Arc]) -> list[Arc]:
    """One arc a pair of pins: a Liberty may have several, each under a condition on other pins."""
    found: dict[tuple[str, str], Arc] = {}
    for arc in arcs:
        before = found.get((arc.source, arc.target), arc)
        found[arc.source, arc.target] = arc._replace(rise=max(arc.rise, before.rise), fall=max(arc.fall, before.fall))
    return list(found.values())


def icarus(delays: Delays, netlist: Netlist, names: Mapping[str, str]) -> str:
    """SDF that Icarus annotates to the last digit. names: instance of ``netlist`` -> its name in the bench."""
    lines = ["(DELAYFILE", ' (SDFVERSION "3.0")', " (DIVIDER /)", " (TIMESCALE 1ns)"]
    for instance in netlist.instances:
        if paths := delays.paths.get(instance.name):
            lines += [" (CELL", f'  (CELLTYPE "{instance.cell}")']
            lines += [f"  (INSTANCE {names[instance.name]})", "  (DELAY (ABSOLUTE"]
            for source, target, rise, fall in paths:
                more = delays.nets.get((instance.name, target), (0.0, 0.0))
                triples = (f"({value:.4f}:{value:.4f}:{value:.4f})" for value in (rise + more[0], fall + more[1]))
                lines.append(f"    (IOPATH {source} {target} {' '.join(triples)})")
            lines.append("  )))")
    return "\n".join([*lines, ")", ""])


def specified(cells: str, delays: Delays, netlist: Netlist) -> str:
    """Add a specify block to every cell of the Verilog ``cells`` that has paths: the annotation requires it."""
    paths: dict[str, dict[tuple[str, str], None]] = {}
    for instance in netlist.instances:
        arcs = delays.paths.get(instance.name, ())
        paths.setdefault(instance.cell, {}).update(dict.fromkeys((arc.source, arc.target) for arc in arcs))

    def add(match: re.Match[str]) -> str:
        arcs = "".join(f" ({source} => {target}) = (0, 0);" for source, target in paths.get(match[1], ()))
        return f"{match[0].removesuffix('endmodule')}specify{arcs} endspecify\nendmodule" if arcs else match[0]

    return re.sub(r"(?ms)^module (\w+)\b.*?^endmodule", add, cells)


def constrained(delays: Delays, netlist: Netlist) -> list[Check]:
    """Checks of the inputs of every register and clock gate."""
    return [
        Check(instance, pin, *values)
        for instance in netlist.instances
        for pin, values in delays.checks.get(instance.name, {}).items()
    ]


def _tree(tokens: Iterator[str]) -> list[Any]:
    """Nested lists of the tokens between parentheses, from after an opening one."""
    made = []
    for token in tokens:
        if token == ")":
            return made
        made.append(_tree(tokens) if token == "(" else token.strip('"'))
    return made


def _groups(tree: list[Any], kind: str) -> list[list[Any]]:
    return [part for part in tree if isinstance(part, list) and part and part[0] == kind]


def _plain(name: str) -> str:
    return name.replace("\\", "")


def _both(values: Sequence[list[str]]) -> tuple[float, float]:
    """Rise and fall of one or two triples."""
    late = [_late(value) for value in values]
    return late[0], late[-1]


def _late(triple: list[str]) -> float:
    """The maximum of [minimum::maximum]."""
    return float(triple[0].split(":")[-1])
