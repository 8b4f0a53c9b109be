"""Resistances of a net of the die from its segments, and its Elmore delays [Elmore1948]."""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from talbot.flow.layout.sensor.plan import CORE, Terminal
from talbot.flow.layout.sensor.routing import BRANCH, STUB, TRUNK
from talbot.flow.layout.timing.parasitics import parasitics
from talbot.platforms.layout import LayoutPlatform

Branches = Sequence[Mapping[str, Any]]


class Edge(NamedTuple):
    """A resistor between two nodes; half of its capacitance is at either end."""

    a: Hashable
    b: Hashable
    ohm: float
    femtofarad: float


def delays(edges: Iterable[Edge], root: Hashable, loads: Mapping[Hashable, float]) -> dict[Hashable, float]:
    """Delay (ns) from ``root`` to each node of a tree of resistors. loads: further capacitance of a node, fF."""
    near: dict[Hashable, list[tuple[Hashable, float]]] = {}
    charge = dict(loads)
    for a, b, ohm, femto in edges:
        for here, there in ((a, b), (b, a)):
            near.setdefault(here, []).append((there, ohm))
            charge[here] = charge.get(here, 0.0) + femto / 2
    order, before = [root], {root: (root, 0.0)}
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


def net(
    branches: Branches,
    y: int,
    driver: Terminal,
    tracks: Mapping[str, int],
    tech: LayoutPlatform,
    pin_pf: float,
    femtofarad: float,
) -> dict[Terminal, float]:
    """Delay (ns) to each terminal, without the driver's own resistance.

    branches: dicts of routing.Branch. y: of the trunk, nm. tracks: dict of routing.Tracks. pin_pf: of every pin but the
    driver's. femtofarad: of all segments, shared by them as their capacitances to the substrate are.
    """
    edges, pins = tree(branches, y, tracks, tech)
    share = femtofarad / sum(edge.femtofarad for edge in edges)
    edges = [edge._replace(femtofarad=share * edge.femtofarad) for edge in edges]
    loads = {node: pin_pf * 1000 for end, node in pins.items() if end != driver}
    found = delays(edges, pins[driver], loads)
    return {end: found[node] for end, node in pins.items() if end != driver}


def tree(
    branches: Branches, y: int, tracks: Mapping[str, int], tech: LayoutPlatform
) -> tuple[list[Edge], dict[Terminal, Hashable]]:
    """Edges of a net, and the node of each terminal.

    From the trunk lead a via and a branch to every pin; of the chip's pins and of pads in the west and the east, three
    vias and a stub follow.
    """
    names = [metal.name for metal in tech.metals]

    def edge(a: Hashable, b: Hashable, level: int, length: int, width: int, vias: Iterable[int] = ()) -> Edge:
        segments = [(names[level], length / 1000, width / 1000)]
        segments += [(f"{names[via]}_{tech.vias[via].name}_{names[via + 1]}", 0.0, 0.0) for via in vias]
        femtofarad, ohm = parasitics(segments, tech)
        return Edge(a, b, ohm, femtofarad)

    edges: list[Edge] = []
    pins: dict[Terminal, Hashable] = {}
    ranked = sorted(branches, key=lambda branch: branch["x"])
    for k, (one, other) in enumerate(zip(ranked, ranked[1:])):
        edges.append(edge(("trunk", k), ("trunk", k + 1), TRUNK, other["x"] - one["x"], tracks["trunk"]))
    for k, branch in enumerate(ranked):
        end = ("end", k)
        edges.append(edge(("trunk", k), end, BRANCH, abs(branch["end"] - y), tracks["branch"], (TRUNK,)))
        if branch["block"] == CORE or branch["side"] != "south":
            left, bottom, right, top = branch["box"]
            length = max(left - branch["x"], branch["x"] - right, 0)
            edges.append(edge(end, ("pin", k), STUB, length, top - bottom, range(STUB, BRANCH)))
            end = ("pin", k)
        pins[branch["block"], branch["pin"]] = end
    return edges, pins
