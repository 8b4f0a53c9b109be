"""The SPEF of a netlist."""

from collections.abc import Container, Mapping, Sequence
from typing import NamedTuple

from talbot.signoff.netlist.netlist import OUTPUT_PINS, Netlist

Node = int | tuple[str, str]


class Tree(NamedTuple):
    """A net as a tree of resistors. A node is a pin (instance, pin), a port ("", port) or a number from 1.

    femtofarad: of all nodes. nodes: fF of each. resistors: (node, node, ohm).
    """

    femtofarad: float
    nodes: Mapping[Node, float]
    resistors: Sequence[tuple[Node, Node, float]]


def one_t(net: tuple[float, float], pins: Sequence[Node]) -> Tree:
    """A net, (fF, ohm), as one T: half of its resistance on either side of its capacitance."""
    femtofarad, ohm = net
    return Tree(femtofarad, {1: femtofarad}, [(pin, 1, max(ohm / 2, 0.001)) for pin in pins])


def spef(netlist: Netlist, nets: Mapping[str, Tree | tuple[float, float]]) -> str:
    """Text of the SPEF. nets: net -> its tree, or (fF, ohm) for `one_t`."""
    pins: dict[str, list[tuple[str, str]]] = {}
    for instance in netlist.instances:
        for pin, net in instance.pins.items():
            pins.setdefault(net, []).append((instance.name, pin))
    ports = {net: port.direction for port in netlist.ports for net in port.bits()}
    lines = ['*SPEF "IEEE 1481-1998"', f'*DESIGN "{netlist.name}"', '*DATE ""', '*VENDOR ""', '*PROGRAM "talbot"']
    lines += ['*VERSION ""', '*DESIGN_FLOW ""', "*DIVIDER /", "*DELIMITER :", "*BUS_DELIMITER [ ]"]
    lines += ["*T_UNIT 1 NS", "*C_UNIT 1 FF", "*R_UNIT 1 OHM", "*L_UNIT 1 HENRY"]
    for net, made in sorted(nets.items()):
        called = _name(net, ports)
        ends: dict[Node, str] = {(owner, pin): f"{_name(owner, ())}:{pin}" for owner, pin in pins.get(net, [])}
        listed = [f"*I {ends[end]} {'O' if end[1] in OUTPUT_PINS else 'I'}" for end in pins.get(net, [])]
        if net in ports:
            ends["", net] = called
            listed.append(f"*P {called} {'I' if ports[net] == 'input' else 'O'}")
        tree = made if isinstance(made, Tree) else one_t(made, list(ends))
        names = {node: f"{called}:{node}" for node in tree.nodes} | ends
        lines += ["", f"*D_NET {called} {tree.femtofarad:.4f}", "*CONN", *listed, "*CAP"]
        lines += [f"{k} {names[node]} {femto:.4f}" for k, (node, femto) in enumerate(tree.nodes.items(), 1)]
        lines.append("*RES")
        lines += [f"{k} {names[a]} {names[b]} {ohm:.3f}" for k, (a, b, ohm) in enumerate(tree.resistors, 1)]
        lines.append("*END")
    return "\n".join(lines) + "\n"


def _name(name: str, ports: Container[str]) -> str:
    """Escape a name as SPEF does: a backslash before everything but letters, digits and _.

    Brackets of a port's bit (a name in ``ports``) stay: a bracket in the name of a register is a letter of it.
    """
    letters = "_[]" if name in ports else "_"
    return "".join(c if c.isalnum() or c in letters else f"\\{c}" for c in name)
