"""OpenSTA's SDF for Icarus 11, which annotates the path delays of cells and no more.

What was measured of Icarus 11.0: IOPATH is annotated when all three values of a triple are there (OpenSTA leaves the
typical one out, and a path then stays without delay and without a word); INTERCONNECT is a syntax error; checks of
setup and hold are not made. So a wire's delay is added to that of the cell that drives it, the largest of its branches
(that of an input port's wire is left out), and setup and hold are modules of the bench (replay.py), each with the later
time of both edges.
"""

import re
from dataclasses import dataclass

from flow.layout.netlist.netlist import is_register

TOKEN = re.compile(r'\(|\)|"[^"]*"|[^\s()]+')


@dataclass(frozen=True)
class Delays:
    """paths: instance -> [(from, to, rise, fall)]. wires: (instance or None for a port, pin or port) -> (rise, fall),
    of the slowest branch. checks: instance -> {pin: [setup, hold]}. All ns."""

    paths: dict
    wires: dict
    checks: dict


def read(text):
    """Delays of an SDF file as OpenSTA writes it; the later value of each triple (for hold too)."""
    tokens = TOKEN.findall(text)
    paths, wires, checks = {}, {}, {}
    for cell in _groups(_tree(iter(tokens[1:])), "CELL"):
        name = next((_plain(part[1]) for part in cell if part[0] == "INSTANCE" and len(part) > 1), None)
        for absolute in (x for delay in _groups(cell, "DELAY") for x in _groups(delay, "ABSOLUTE")):
            for _, source, target, *values in _groups(absolute, "IOPATH"):
                paths.setdefault(name, []).append((source, target, *_both(values)))
            for _, source, _, *values in _groups(absolute, "INTERCONNECT"):
                instance, _, pin = source.rpartition("/")
                end = _plain(instance) if instance else None, _plain(pin)
                wires[end] = tuple(map(max, wires.get(end, (0.0, 0.0)), _both(values)))
        for group in _groups(cell, "TIMINGCHECK"):
            for k, kind in enumerate(("SETUP", "HOLD")):
                for _, data, _, value in _groups(group, kind):
                    worst = checks.setdefault(name, {}).setdefault(data[-1], [-1e9, -1e9])
                    worst[k] = max(worst[k], _late(value))
    return Delays(paths, wires, checks)


def icarus(delays, netlist, names):
    """SDF that Icarus annotates to the last digit. names: dict instance of ``netlist`` -> its name in the bench."""
    lines = ["(DELAYFILE", ' (SDFVERSION "3.0")', " (DIVIDER /)", " (TIMESCALE 1ns)"]
    for instance in netlist.instances:
        paths = delays.paths.get(instance.name)
        if paths:
            lines += [
                " (CELL",
                f'  (CELLTYPE "{instance.cell}")',
                f"  (INSTANCE {names[instance.name]})",
                "  (DELAY (ABSOLUTE",
            ]
            for source, target, rise, fall in paths:
                more = delays.wires.get((instance.name, target), (0.0, 0.0))
                triples = (f"({value:.4f}:{value:.4f}:{value:.4f})" for value in (rise + more[0], fall + more[1]))
                lines.append(f"    (IOPATH {source} {target} {' '.join(triples)})")
            lines.append("  )))")
    return "\n".join([*lines, ")", ""])


def specified(cells, delays, netlist):
    """The Verilog ``cells`` with a specify block in every cell that has paths: what an annotation needs."""
    paths = {}
    for instance in netlist.instances:
        paths.setdefault(instance.cell, {}).update(
            {(source, target): None for source, target, *_ in delays.paths.get(instance.name, ())}
        )

    def add(match):
        arcs = "".join(f" ({source} => {target}) = (0, 0);" for source, target in paths.get(match[1], ()))
        return f"{match[0].removesuffix('endmodule')}specify{arcs} endspecify\nendmodule" if arcs else match[0]

    return re.sub(r"(?ms)^module (\w+)\b.*?^endmodule", add, cells)


def constrained(delays, netlist):
    """(instance, data pin, setup, hold) of every register's inputs."""
    return [
        (instance, pin, *values)
        for instance in netlist.instances
        if is_register(instance.cell)
        for pin, values in delays.checks.get(instance.name, {}).items()
    ]


def _tree(tokens):
    """Nested lists of what stands between parentheses, from behind an opening one."""
    made = []
    for token in tokens:
        if token == ")":
            return made
        made.append(_tree(tokens) if token == "(" else token.strip('"'))
    return made


def _groups(tree, kind):
    return [part for part in tree if isinstance(part, list) and part and part[0] == kind]


def _plain(name):
    return name.replace("\\", "")


def _both(values):
    """(rise, fall) of one or two triples."""
    late = [_late(value) for value in values]
    return late[0], late[-1]


def _late(triple):
    """Of [minimum::maximum], the latter."""
    return float(triple[0].split(":")[-1])
