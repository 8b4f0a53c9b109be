"""A layout with blocks that were laid out before, as one without: their cells and wires among its own."""

from flow.layout.netlist.netlist import Instance, Netlist


def flat(netlist, blocks):
    """The Netlist ``netlist`` with each block in place of its instance; its names are behind the instance's and a dot.

    blocks: dict instance -> Netlist of the block.
    """
    outside, instances = {}, []
    for instance in netlist.instances:
        if instance.name in blocks:
            outside[instance.name] = instance.pins
        else:
            instances.append(instance)
    for name, block in blocks.items():
        instances += [
            Instance(
                f"{name}.{i.name}",
                i.cell,
                {pin: outside[name].get(net, f"{name}.{net}") for pin, net in i.pins.items()},
            )
            for i in block.instances
        ]
    return Netlist(netlist.name, netlist.ports, tuple(instances))


def together(netlist, placement, blocks, places):
    """The placement of `flat`: the instances in its order, and the wires of nets that reach into blocks as one.

    blocks: dict instance -> (Netlist, placement of the block). places: dict instance -> (x, y) of it, um.
    """
    kept = [
        where
        for instance, where in zip(netlist.instances, placement["instances"], strict=True)
        if instance.name not in blocks
    ]
    wires, pins = dict(placement["segments"]), {i.name: i.pins for i in netlist.instances if i.name in blocks}
    for name, (_, inside) in blocks.items():
        dx, dy = places[name]
        kept += [
            [number, cell, round(x + dx, 4), round(y + dy, 4), orientation]
            for number, cell, x, y, orientation in inside["instances"]
        ]
        for net, made in inside["segments"].items():
            outer = pins[name].get(net, f"{name}.{net}")
            wires[outer] = wires.get(outer, []) + made
    return placement | {"instances": kept, "segments": wires}
