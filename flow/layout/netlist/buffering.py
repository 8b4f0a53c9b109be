"""Trees of buffers where a signal goes to many cells; cells that will lie near each other share one.

The mapper limits what is behind its own gates only: for it a port or a register drives anything. Where cells will lie is
guessed as a placer begins: at the least sum of the squares of all wires' lengths, the ports held on the die's edges.
"""

from dataclasses import replace

import numpy as np
from scipy.sparse import coo_array, diags_array
from scipy.sparse.linalg import cg

from .netlist import OUTPUT_PINS, Instance

PULL = 1e-4  # of every cell to the middle, a wire's being 1: what hangs on no port needs a place, too
TOLERANCE = 1e-8  # of the equations' right side


def buffered(netlist, sides, buffer, most):
    """The Netlist with at most ``most`` cells' pins behind a net; clocks are left alone.

    sides: dict side -> nets of the ports there in their order, the west first. buffer: (cell, input, output).
    """
    instances = [replace(i, pins=dict(i.pins)) for i in netlist.instances]
    clocks = {i.pins["clk"] for i in instances if "clk" in i.pins}
    sinks = {}
    for number, instance in enumerate(instances):
        for pin, net in instance.pins.items():
            if pin not in OUTPUT_PINS and net not in clocks:
                sinks.setdefault(net, []).append((number, pin))
    large = {net: ends for net, ends in sinks.items() if len(ends) > most}
    places = guessed(instances, sides, {*large, *clocks}) if large else None
    for net, ends in large.items():
        instances += _tree(
            net,
            [(instances[number].pins, pin) for number, pin in ends],
            places[[number for number, _ in ends]],
            buffer,
            most,
        )
    return replace(netlist, instances=tuple(instances))


def driven(netlist, buffer):
    """The Netlist with a buffer of its own behind every output: what it leads to outside slows nothing within."""
    outputs = {net: f"{net}_within" for port in netlist.ports if port.direction == "output" for net in port.bits()}
    cell, taken, given = buffer
    instances = [
        replace(i, pins={pin: outputs.get(net, net) for pin, net in i.pins.items()}) for i in netlist.instances
    ]
    return replace(
        netlist,
        instances=(
            *instances,
            *(Instance(f"{net}_driver", cell, {taken: within, given: net}) for net, within in outputs.items()),
        ),
    )


def _tree(net, ends, places, buffer, most):
    """Buffers between ``net`` and its ``ends``, (dict of an instance's pins, pin), which lie at ``places``; they are
    joined to them."""
    cell, taken, given = buffer
    made = []
    while len(ends) > most:
        groups, above = parted(places, most), []
        for group in groups:
            name = f"{net}_fan{len(made)}"
            made.append(Instance(f"{name}_buffer", cell, {taken: net, given: name}))  # OpenSTA mixes up equal names
            above.append((made[-1].pins, taken))
            for pins, pin in (ends[k] for k in group):
                pins[pin] = name
        ends, places = above, np.array([places[group].mean(axis=0) for group in groups])
    return made


def parted(places, most):
    """Indices of ``places`` (n, 2) in groups of near ones, at most ``most`` in each and nearly as many in all: list of
    arrays. The longer side is cut first."""
    count = -(-len(places) // most)

    def cut(indices, count):
        if count == 1:
            return [indices]
        axis = np.argmax(np.ptp(places[indices], axis=0))
        ordered = indices[np.argsort(places[indices, axis], kind="stable")]
        first = count // 2
        at = round(len(ordered) * first / count)
        return cut(ordered[:at], first) + cut(ordered[at:], count - first)

    return cut(np.arange(len(places)), count)


def guessed(instances, sides, left_out=()):
    """Places of ``instances`` in a square of side 1: array (n, 2). left_out: nets that pull at nothing.

    A net is a star around a node of its own. Solves Laplacian x = pull of the ports by conjugate gradients.
    """
    ports = {
        net: (side, (k + 0.5) / len(nets)) for side, nets in enumerate(sides.values()) for k, net in enumerate(nets)
    }
    nets = {}
    wires = [
        (number, len(instances) + nets.setdefault(net, len(nets)))
        for number, instance in enumerate(instances)
        for net in instance.pins.values()
        if net not in left_out
    ]
    size = len(instances) + len(nets)
    held = {len(instances) + number: ports[net] for net, number in nets.items() if net in ports}
    one, other = np.array(wires).T
    pulls = coo_array((np.ones(len(wires)), (one, other)), (size, size)).tocsr()
    pulls = pulls + pulls.T
    anchor = np.full(size, PULL)
    anchor[list(held)] += 1
    right = np.full((size, 2), PULL / 2)
    right[list(held)] += np.array(list(held.values())).reshape(-1, 2)
    matrix = diags_array(pulls.sum(axis=1) + anchor) - pulls
    inverse = diags_array(1 / matrix.diagonal())
    return np.stack([cg(matrix, b, M=inverse, rtol=TOLERANCE)[0] for b in right.T], 1)[: len(instances)]
