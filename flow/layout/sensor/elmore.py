"""Capacitance of a net of the die and its Elmore delays [Elmore1948], from the lengths of its wires."""

from flow.layout.timing.parasitics import parasitics

from .plan import CORE
from .routing import STUB, TRUNK, VERTICAL


def delays(edges, root, loads):
    """dict node -> ns from ``root`` in a tree of resistors.

    edges: list of (node, node, Ohm, fF); half of an edge's capacitance is at either end. loads: dict node -> fF more.
    """
    near, charge = {}, dict(loads)
    for a, b, ohm, femto in edges:
        for here, there in ((a, b), (b, a)):
            near.setdefault(here, []).append((there, ohm))
            charge[here] = charge.get(here, 0.0) + femto / 2
    order, before = [root], {root: (None, 0.0)}
    for node in order:
        for there, ohm in near.get(node, ()):
            if there not in before:
                before[there] = node, ohm
                order.append(there)
    for node in reversed(order[1:]):  # what is charged through its edge
        charge[before[node][0]] += charge[node]
    found = {root: 0.0}
    for node in order[1:]:
        parent, ohm = before[node]
        found[node] = found[parent] + ohm * charge[node] * 1e-6  # Ohm fF = 1e-6 ns
    return found


def net(reaches, y, driver, tracks, known, pin_pf):
    """(fF of all wires, dict (block, pin) -> ns behind the driver, its own resistance left out).

    reaches: dicts of routing.Reach; y: of the trunk, nm; driver: (block, pin). tracks: dict of routing.Tracks. known:
    CoriolisPlatform. pin_pf: of every pin but the driver's.
    """
    edges, pins = tree(reaches, y, tracks, known)
    loads = {node: pin_pf * 1000 for end, node in pins.items() if end != driver}
    found = delays(edges, pins[driver], loads)
    return sum(femto for *_, femto in edges), {end: found[node] for end, node in pins.items() if end != driver}


def tree(reaches, y, tracks, known):
    """(list of edges as of `delays`, dict (block, pin) -> its node): a trunk, from it a cut and a vertical to every
    pin, and of the chip's pins three cuts and a stub."""

    def wire(level, length, width, cuts=()):
        parts = [(known.metals[level].name, length / 1000, width / 1000)]
        parts += [
            (f"{known.metals[cut].name}_{known.vias[cut].name}_{known.metals[cut + 1].name}", 0, 0) for cut in cuts
        ]
        femto, ohm = parasitics(parts, known)
        return ohm, femto

    edges, pins, ranked = [], {}, sorted(reaches, key=lambda reach: reach["x"])
    for k, (one, other) in enumerate(zip(ranked, ranked[1:])):
        edges.append((("trunk", k), ("trunk", k + 1), *wire(TRUNK, other["x"] - one["x"], tracks["trunk"])))
    for k, reach in enumerate(ranked):
        end = ("end", k)
        edges.append((("trunk", k), end, *wire(VERTICAL, abs(reach["end"] - y), tracks["vertical"], cuts=(TRUNK,))))
        if reach["block"] == CORE:
            left, bottom, right, top = reach["box"]
            length = max(left - reach["x"], reach["x"] - right, 0)
            edges.append((end, ("pin", k), *wire(STUB, length, top - bottom, cuts=range(STUB, VERTICAL))))
            end = ("pin", k)
        pins[reach["block"], reach["pin"]] = end
    return edges, pins
