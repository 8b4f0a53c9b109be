"""Short names of nets for tools that do not take every name that Verilog allows."""

from collections.abc import Iterable
from typing import Any

from .netlist import MacroNames, Netlist

CLOCK = "clk"  # name of the clock net in the netlist given to Coriolis
MACRO = "macro"  # and a number: a macro's cell in Coriolis


def plain_names(netlist: Netlist, clock: str) -> dict[str, str]:
    """Map each net to a name of letters and digits only; the net ``clock`` to CLOCK."""
    nets = dict.fromkeys(net for port in netlist.ports for net in port.bits())
    nets.update(dict.fromkeys(net for instance in netlist.instances for net in instance.pins.values()))
    return {net: CLOCK if net == clock else f"w{number}" for number, net in enumerate(nets)}


def plain_macros(netlist: Netlist, placed: Iterable[dict[str, Any]]) -> MacroNames:
    """Map each macro of the floorplan's list ``placed`` to (cell, names of its pins) in Coriolis."""
    found = {instance.name: instance for instance in netlist.instances}
    return {
        macro["instance"]: (f"{MACRO}{k}", {pin: f"p{j}" for j, pin in enumerate(found[macro["instance"]].pins)})
        for k, macro in enumerate(placed)
    }
