"""The netlist and the placement by the names of the design."""

import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from talbot.base.steps import StepError

from .netlist import SUPPLIES, Instance, MacroNames, Netlist

# Hurricane's orientations of cells in rows: KLayout's transformation, factors of x and y
TURNS = {"0": "R0", "2": "R180", "4": "M90", "6": "M0"}
MIRRORED = {"0": (1, 1), "2": (-1, -1), "4": (-1, 1), "6": (1, -1)}


Masters = Mapping[str, Mapping[str, list[list[Any]]]]  # by cell and pin the boxes as drawn, see `pin_boxes`


def placed_netlist(
    netlist: Netlist, names: Mapping[str, str], placed: Sequence[Sequence[Any]], macros: MacroNames
) -> Netlist:
    """Add what Coriolis added: the clock tree's buffers, and fill cells.

    names: see `plain_names`. placed: [name, cell, x, y, orientation, {pin: net}] of every instance. macros: see
    `plain_macros`. Raises StepError if an instance is lost.
    """
    own, instances, seen = own_name(names), [], set()
    for name, cell, *_, plain_pins in placed:
        pins = {pin: own(net) for pin, net in plain_pins.items() if pin not in SUPPLIES}
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
    own = own_name(names)
    return {
        "straps": result["straps"],
        "pins": [[side, own(net), at] for side, net, at in result["pins"]],
        "instances": [[_number(name), *rest[:4]] for name, *rest in result["instances"]],
    }


def own_name(names: Mapping[str, str]) -> Callable[[str], str]:
    """The design's name of a net of Coriolis's; nets of the clock tree have none. names: see `plain_names`."""
    nets = {plain: net for net, plain in names.items()}
    return lambda plain: nets.get(plain, f"cts_{plain}")


def pin_boxes(netlist: Netlist, placed: Sequence[Sequence[Any]], masters: Masters) -> dict[str, list[list[list[Any]]]]:
    """By net, of every pin the boxes of which any one is to be met, [layer, left, bottom, right, top] in um.

    placed: [number, cell, x, y, orientation] of every instance. masters: by cell and pin such boxes, as drawn.
    """
    made: dict[str, list[list[list[Any]]]] = {}
    for instance, (_, _, x, y, orientation) in zip(netlist.instances, placed, strict=True):
        across, up = MIRRORED[orientation]
        for pin, net in instance.pins.items():
            boxes = []
            for layer, *box in masters[instance.cell][pin]:
                left, right = sorted(x + across * box[k] for k in (0, 2))
                bottom, top = sorted(y + up * box[k] for k in (1, 3))
                boxes.append([layer, *(round(value, 4) for value in (left, bottom, right, top))])
            made.setdefault(net, []).append(boxes)
    return made


def _number(name: str) -> int | None:
    """Place in the BLIF file of an instance that came from it, or None."""
    match = re.fullmatch(r"subckt_(\d+)_\w+", name)
    return int(match[1]) if match else None
