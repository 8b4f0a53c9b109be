"""The stuck-at faults of a netlist: every pin of every gate at 0 and at 1, one of each set of equivalent ones."""

from typing import NamedTuple

import numpy as np

from talbot.verif.stuck_at.netlist import AND, BUF, NAND, NOR, NOT, OR, PINS, Gates

OUTPUT = 3  # the pin after the inputs
# Kind -> (value of an input, value of the output that it forces): a fault at the one is a fault at the other
FORCES = {AND: [(0, 0)], NAND: [(0, 1)], OR: [(1, 1)], NOR: [(1, 0)], NOT: [(0, 1), (1, 0)], BUF: [(0, 0), (1, 1)]}


class Fault(NamedTuple):
    """Pin ``pin`` of gate ``gate`` (0..2, or OUTPUT) is stuck at ``value``."""

    gate: int
    pin: int
    value: int


def collapsed(gates: Gates) -> list[Fault]:
    """Return one fault of each class of equivalent ones, in the order of the gates."""
    driver = {int(out): gate for gate, out in enumerate(gates.out)}
    fan_out = np.bincount(gates.ins.ravel(), minlength=gates.nets)
    for nets in gates.outputs.values():
        np.add.at(fan_out, nets, 1)
    parent: dict[Fault, Fault] = {}

    def root(fault: Fault) -> Fault:
        while (up := parent.setdefault(fault, fault)) != fault:
            fault = up
        return fault

    for gate, kind in enumerate(gates.kinds):
        for value in (0, 1):
            root(Fault(gate, OUTPUT, value))
        for pin in range(len(PINS.get(int(kind), "AB"))):
            net = int(gates.ins[gate, pin])
            for value in (0, 1):
                if net in driver and fan_out[net] == 1:  # the wire is the driver's output
                    parent[root(Fault(gate, pin, value))] = root(Fault(driver[net], OUTPUT, value))
                root(Fault(gate, pin, value))
            for value, forced in FORCES.get(int(kind), ()):
                parent[root(Fault(gate, pin, value))] = root(Fault(gate, OUTPUT, forced))
    return sorted({root(fault) for fault in list(parent)})
