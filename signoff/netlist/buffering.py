"""Buffer trees for nets with a large fan-out; cells that will be near each other share a buffer.

The mapper limits the fan-out of its own gates only: for it a port or a register drives anything. Positions are
estimated by quadratic placement: the least sum of the squared lengths of all nets, ports fixed on the die's edges.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array, diags_array
from scipy.sparse.linalg import cg

from talbot.signoff.netlist.netlist import OUTPUT_PINS, Buffer, Instance, Netlist

PULL = 1e-4  # of every cell to the middle, a net's being 1: a cell without a path to a port needs a position, too
TOLERANCE = 1e-8  # of the equations' right side
Points = npt.NDArray[np.float64]  # (n, 2)


def buffer_fan_out(netlist: Netlist, sides: Mapping[str, Sequence[str]], buffer: Buffer, most: int) -> Netlist:
    """Limit the fan-out of every net except clocks to ``most`` pins.

    sides: nets of the ports by side, in their order, the west first.
    """
    instances = [replace(i, pins=dict(i.pins)) for i in netlist.instances]
    clocks = {i.pins["clk"] for i in instances if "clk" in i.pins}
    sinks: dict[str, list[tuple[int, str]]] = {}
    for number, instance in enumerate(instances):
        for pin, net in instance.pins.items():
            if pin not in OUTPUT_PINS and net not in clocks:
                sinks.setdefault(net, []).append((number, pin))
    large = {net: ends for net, ends in sinks.items() if len(ends) > most}
    places = estimated(instances, sides, {*large, *clocks}) if large else np.empty((0, 2))
    for net, ends in large.items():
        pins = [(instances[number].pins, pin) for number, pin in ends]
        instances += _tree(net, pins, places[[number for number, _ in ends]], buffer, most)
    return replace(netlist, instances=tuple(instances))


def buffer_outputs(netlist: Netlist, buffer: Buffer, weak: Collection[str] | None = None) -> Netlist:
    """Insert a buffer in front of every output: its load outside slows no path inside.

    weak: cells that do not bear that load; only outputs that one of them drives get a buffer.
    """
    outputs = {net: f"{net}_within" for port in netlist.ports if port.direction == "output" for net in port.bits()}
    if weak is not None:
        driven = {i.pins[pin] for i in netlist.instances if i.cell in weak for pin in OUTPUT_PINS if pin in i.pins}
        outputs = {net: within for net, within in outputs.items() if net in driven}
    instances = [instance.with_nets(outputs) for instance in netlist.instances]
    drivers = [buffer.instance(f"{net}_driver", within, net) for net, within in outputs.items()]
    return replace(netlist, instances=(*instances, *drivers))


def _tree(
    net: str, ends: list[tuple[dict[str, str], str]], places: Points, buffer: Buffer, most: int
) -> list[Instance]:
    """Buffers between ``net`` and its ``ends``, (pins of an instance, pin) at ``places``, whose nets are changed."""
    made: list[Instance] = []
    while len(ends) > most:
        groups, above = clusters(places, most), []
        for group in groups:
            name = f"{net}_fan{len(made)}"
            made.append(buffer.instance(f"{name}_buffer", net, name))  # OpenSTA mixes up equal names
            above.append((made[-1].pins, buffer.input))
            for pins, pin in (ends[k] for k in group):
                pins[pin] = name
        ends, places = above, np.array([places[group].mean(axis=0) for group in groups])
    return made


def clusters(places: Points, most: int) -> list[npt.NDArray[np.int64]]:
    """Indices of ``places`` in groups of near ones, at most ``most`` in each and nearly as many in all.

    The longer side is cut first.
    """
    count = -(-len(places) // most)

    def cut(indices: npt.NDArray[np.int64], count: int) -> list[npt.NDArray[np.int64]]:
        """Cut ``indices`` into ``count`` groups."""
        if count == 1:
            return [indices]
        axis = np.argmax(np.ptp(places[indices], axis=0))
        ordered = indices[np.argsort(places[indices, axis], kind="stable")]
        first = count // 2
        at = round(len(ordered) * first / count)
        return cut(ordered[:at], first) + cut(ordered[at:], count - first)

    return cut(np.arange(len(places)), count)


def estimated(
    instances: Sequence[Instance], sides: Mapping[str, Sequence[str]], left_out: Collection[str] = ()
) -> Points:
    """Positions of ``instances`` in a square of side 1: array (n, 2). left_out: nets without a pull.

    A net is a star around a node of its own. Solves Laplacian x = pull of the ports by conjugate gradients.
    """
    ports = {n: (x, (k + 0.5) / len(nets)) for x, nets in enumerate(sides.values()) for k, n in enumerate(nets)}
    nets: dict[str, int] = {}
    pins = [(k, net) for k, i in enumerate(instances) for net in i.pins.values() if net not in left_out]
    branches = [(k, len(instances) + nets.setdefault(net, len(nets))) for k, net in pins]
    size = len(instances) + len(nets)
    held = {len(instances) + number: ports[net] for net, number in nets.items() if net in ports}
    one, other = np.array(branches).T
    pulls = coo_array((np.ones(len(branches)), (one, other)), (size, size)).tocsr()
    pulls = pulls + pulls.T
    anchor = np.full(size, PULL)
    anchor[list(held)] += 1
    right = np.full((size, 2), PULL / 2)
    right[list(held)] += np.array(list(held.values())).reshape(-1, 2)
    matrix = diags_array(pulls.sum(axis=1) + anchor) - pulls
    inverse = diags_array(1 / matrix.diagonal())
    return np.stack([cg(matrix, b, M=inverse, rtol=TOLERANCE)[0] for b in right.T], 1)[: len(instances)]
