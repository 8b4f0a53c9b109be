"""The netlist and the placement by the names of the design."""

import re
from collections.abc import Mapping, Sequence
from typing import Any

from base.steps import StepError

from .netlist import SUPPLIES, Instance, MacroNames, Netlist


def placed_netlist(
    netlist: Netlist, names: Mapping[str, str], placed: Sequence[Sequence[Any]], macros: MacroNames
) -> Netlist:
    """Add what Coriolis added: the clock tree's buffers, and fill cells.

    names: see `plain_names`. placed: [name, cell, x, y, orientation, {pin: net}] of every instance. macros: see
    `plain_macros`. Raises StepError if an instance is lost.
    """
    nets, instances, seen = {plain: net for net, plain in names.items()}, [], set()
    for name, cell, *_, plain_pins in placed:
        pins = {pin: nets.get(net, f"cts_{net}") for pin, net in plain_pins.items() if pin not in SUPPLIES}
        number = _number(name)
        if number is not None:
            seen.add(number)
            was = netlist.instances[number]
            name = was.name
            if name in macros:
                cell, pins = was.cell, {pin: pins[plain] for pin, plain in macros[name][1].items()}
        instances.append(Instance(name, cell, pins))
    if len(seen) != len(netlist.instances):
        raise StepError(f"place: {len(netlist.instances) - len(seen)} instances are not in the layout")
    return Netlist(netlist.name, netlist.ports, tuple(instances))


def placement(names: Mapping[str, str], result: Mapping[str, Any]) -> dict[str, Any]:
    """Coriolis's ``result`` as reports and extraction read it, nets by their own names: for JSON."""
    nets = {plain: net for net, plain in names.items()}
    return {
        "straps": result["straps"],
        "pins": [[side, nets[net], at] for side, net, at in result["pins"]],
        "instances": [[_number(name), *rest[:4]] for name, *rest in result["instances"]],
    }


def _number(name: str) -> int | None:
    """Place in the BLIF file of an instance that came from it, or None."""
    match = re.fullmatch(r"subckt_(\d+)_\w+", name)
    return int(match[1]) if match else None
