"""A design with macros as one without: their cells and segments among its own."""

from collections.abc import Mapping
from typing import Any

from .netlist import Instance, Netlist

Placement = dict[str, Any]  # see netlist.placed.placement


def flattened(netlist: Netlist, macros: Mapping[str, Netlist]) -> Netlist:
    """Put each of ``macros`` in place of its instance; its names follow the instance's and a dot."""
    outside = {instance.name: instance.pins for instance in netlist.instances if instance.name in macros}
    instances = [instance for instance in netlist.instances if instance.name not in macros]
    for name, macro in macros.items():
        for i in macro.instances:
            pins = {pin: outside[name].get(net, f"{name}.{net}") for pin, net in i.pins.items()}
            instances.append(Instance(f"{name}.{i.name}", i.cell, pins))
    return Netlist(netlist.name, netlist.ports, tuple(instances))


def merged_placement(
    netlist: Netlist, placement: Placement, macros: Mapping[str, Placement], places: Mapping[str, tuple[float, float]]
) -> Placement:
    """The placement of `flattened`: the instances in its order, and the segments of nets that reach into macros as one.

    macros: placements by instance. places: (x, y) of each, um.
    """
    kept = [at for i, at in zip(netlist.instances, placement["instances"], strict=True) if i.name not in macros]
    segments, pins = dict(placement["segments"]), {i.name: i.pins for i in netlist.instances if i.name in macros}
    for name, inside in macros.items():
        dx, dy = places[name]
        for number, cell, x, y, orientation in inside["instances"]:
            kept.append([number, cell, round(x + dx, 4), round(y + dy, 4), orientation])
        for net, made in inside["segments"].items():
            outer = pins[name].get(net, f"{name}.{net}")
            segments[outer] = segments.get(outer, []) + made
    return placement | {"instances": kept, "segments": segments}
