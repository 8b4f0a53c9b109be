"""A design with macros as one without: their cells and segments among its own."""

from collections.abc import Mapping
from typing import Any

from .netlist import Instance, Netlist


def flattened(netlist: Netlist, macros: Mapping[str, Netlist]) -> Netlist:
    """Put each of ``macros`` in place of its instance; its names follow the instance's and a dot."""
    outside = {instance.name: instance.pins for instance in netlist.instances if instance.name in macros}
    instances = [instance for instance in netlist.instances if instance.name not in macros]
    for name, macro in macros.items():
        instances += [
            Instance(
                f"{name}.{i.name}",
                i.cell,
                {pin: outside[name].get(net, f"{name}.{net}") for pin, net in i.pins.items()},
            )
            for i in macro.instances
        ]
    return Netlist(netlist.name, netlist.ports, tuple(instances))


def merged_placement(
    netlist: Netlist,
    placement: dict[str, Any],
    macros: Mapping[str, dict[str, Any]],
    places: Mapping[str, tuple[float, float]],
) -> dict[str, Any]:
    """The placement of `flattened`: the instances in its order, and the segments of nets that reach into macros as one.

    macros: placements by instance. places: (x, y) of each, um.
    """
    kept = [
        where
        for instance, where in zip(netlist.instances, placement["instances"], strict=True)
        if instance.name not in macros
    ]
    segments, pins = dict(placement["segments"]), {i.name: i.pins for i in netlist.instances if i.name in macros}
    for name, inside in macros.items():
        dx, dy = places[name]
        kept += [
            [number, cell, round(x + dx, 4), round(y + dy, 4), orientation]
            for number, cell, x, y, orientation in inside["instances"]
        ]
        for net, made in inside["segments"].items():
            outer = pins[name].get(net, f"{name}.{net}")
            segments[outer] = segments.get(outer, []) + made
    return placement | {"instances": kept, "segments": segments}
