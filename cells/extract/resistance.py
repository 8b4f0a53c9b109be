"""Resistance of contacts and conductors between a net's pin, its sources and drains, and its gates.

KLayout's network extraction counts squares on every conductor; a source or drain is one node, connected to the metal
above by its contacts (a p diffusion with one contact has 585 ohm before its transistor). Of the network's inner nodes
those with at most BRANCHES resistors are then taken out, which changes nothing for its terminals. Without any inner
nodes a net of n terminals has n^2 / 2 resistors, and buf_16 takes twice as long.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any, NamedTuple

from talbot.base.gds import db, pex
from talbot.cells.extract.devices import CellLayout, Device
from talbot.models.parameters import ParameterError
from talbot.platforms.extraction import ExtractionPlatform
from talbot.platforms.layers import DIFFUSION

IDEAL = 1e-3  # ohm a square of a diffusion, in which the transistor's model has the resistance
LEAST = 1e-3  # ohm; what is less is as much
MOST = 1e6  # ohm; what is more is left out
BRANCHES = 5  # of a node that is taken out
Points = Mapping[int, Sequence["db.Point"]]  # by number of the conductor
Polygons = Mapping[int, Sequence["db.Polygon"]]


@dataclass(frozen=True)
class Resistances:
    """Resistors and the nodes that transistors are at.

    resistors: (node, node, ohm). terminals: device number -> 'drain', 'gate' or 'source' -> node; a terminal that is
    not in it is at the node with its net's name.
    """

    resistors: list[tuple[str, str, float]]
    terminals: dict[int, dict[str, str]]


class Terminal(NamedTuple):
    """The point where a transistor's 'drain', 'gate' or 'source' (device by number) meets a net."""

    device: int
    role: str
    conductor: str
    region: "db.Region"


class Port(NamedTuple):
    """A place on a net, and the terminals (device, role) there."""

    conductor: str
    shape: "db.Region | db.Point"
    users: list[tuple[int, str]]


def resistances(layout: CellLayout, tech: ExtractionPlatform) -> Resistances:
    """Resistances of a cell. Raises ParameterError for a net whose terminals no resistance connects."""
    resistors, terminals = [], {i: {} for i in range(len(layout.devices))}
    by_net: dict[str, list[Terminal]] = {}
    for i, device in enumerate(layout.devices):
        for role, (conductor, region) in _sides(device, layout).items():
            by_net.setdefault(getattr(device, role), []).append(Terminal(i, role, conductor, region))
    for net in sorted(by_net):
        ports = _ports(net, by_net[net], layout)
        nodes = [net, *(f"{net}_r{k}" for k in range(1, len(ports)))]
        for node, port in zip(nodes, ports, strict=True):
            for i, role in port.users:
                terminals[i][role] = node
        if len(ports) > 1:
            every = _conductances(net, ports, layout, tech)
            kept = {pair: siemens for pair, siemens in every.items() if siemens > 1 / MOST}
            if set(range(len(ports))) - {end for pair in kept for end in pair}:
                raise ParameterError(f"net = {net}: no resistance below {MOST:g} ohm joins its {len(ports)} terminals")
            number = dict(enumerate(nodes))
            for end in sorted({end for pair in kept for end in pair} - set(number)):
                number[end] = f"{net}_r{len(number)}"
            resistors += [(number[a], number[b], 1 / siemens) for (a, b), siemens in sorted(kept.items())]
    return Resistances(resistors, terminals)


def _sides(device: Device, layout: CellLayout) -> "dict[str, tuple[str, db.Region]]":
    """Role -> (conductor, region) of a transistor: its gate's poly, the islands of its source and drain."""
    step = round(device.length / layout.dbu / 2) + 10
    poly, gate = layout.shapes["poly"][device.gate], db.Box(device.at, device.at).enlarged(5)
    sides = {"gate": ("poly", (poly & layout.active).interacting(db.Region(gate)))}
    left, right = (_island(device, layout, sign * step) for sign in (-1, 1))
    crossed = left[0] != device.source
    sides["source"], sides["drain"] = ((device.kind, side[1]) for side in ((right, left) if crossed else (left, right)))
    return sides


def _island(device: Device, layout: CellLayout, step: int) -> "tuple[str, db.Region]":
    """Return (net, region) of the diffusion ``step`` dbu from the centre of a gate."""
    spot = db.Region(db.Box(device.at, device.at).enlarged(2).moved(step, 0))
    for net, islands in layout.islands[device.kind].items():
        part = islands.merged().interacting(spot)
        if not part.is_empty():
            return net, part
    raise AssertionError(f"no diffusion next to a gate of {device.gate}")


def _ports(net: str, terminals: Sequence[Terminal], layout: CellLayout) -> list[Port]:
    """The ports of a net's terminals; its pin, if it has one, first."""
    by_place: dict[tuple[bool, str, str], Port] = {}
    for i, role, conductor, region in terminals:
        place = conductor != "poly", str(region.bbox()), conductor
        by_place.setdefault(place, Port(conductor, region, [])).users.append((i, role))
    ports = [port for _, port in sorted(by_place.items(), key=lambda item: item[0][:2])]
    for conductor, point in layout.labels.get(net, ()):
        spot = db.Region(db.Box(point, point).enlarged(1))
        if not layout.shapes[conductor].get(net, db.Region()).interacting(spot).is_empty():
            return [Port(conductor, point, []), *ports]
    return ports


def _conductances(
    net: str, ports: Sequence[Port], layout: CellLayout, tech: ExtractionPlatform
) -> dict[tuple[int, int], float]:
    """Conductance in S of pairs of nodes of ``net``: ports, numbered in their order, and inner nodes, from there."""
    names = ["n", "p", *(layer.lef for layer in tech.conductors)]
    number = {name: k for k, name in enumerate(names)}
    rules, geometry = pex.RExtractorTech(), {}
    for name in names:
        region = (layout.islands[name] if name in layout.islands else layout.shapes[name]).get(net)
        if region is not None:
            geometry[number[name]] = region.merged()
            conductor = pex.RExtractorTechConductor()
            conductor.layer = number[name]
            conductor.resistance = IDEAL if name in layout.islands else tech.conductor(name).sheet_ohm
            rules.add_conductor(conductor)
    for k, (region, via) in enumerate(zip(layout.vias, tech.vias, strict=True)):
        below = {*via.below, *(layout.islands if DIFFUSION in via.below else ())}
        upper = number[via.above]
        for name in (name for name in names if name in below and {number[name], upper} <= geometry.keys()):
            lower = number[name]
            cut = region & geometry[lower] & geometry[upper]
            if not cut.is_empty():
                layer = len(names) * (k + 1) + lower
                geometry[layer], via_rule = cut, pex.RExtractorTechVia()
                via_rule.cut_layer, via_rule.bottom_conductor, via_rule.top_conductor = layer, lower, upper
                via_rule.resistance = tech.contact_ohm[name] * (cut.area() / cut.count() * 1e-6)
                rules.add_via(via_rule)
    points: dict[int, list[db.Point]] = {}
    flat: dict[int, list[db.Polygon]] = {}
    for port in ports:
        if isinstance(port.shape, db.Point):
            points.setdefault(number[port.conductor], []).append(port.shape)
        else:
            flat.setdefault(number[port.conductor], []).extend(port.shape.merged().each())
    network = _network(layout.dbu, rules, geometry, points, flat)
    return _reduced(network, [(number[port.conductor], port.shape) for port in ports], flat)


def _network(dbu: float, rules: Any, geometry: "Mapping[int, db.Region]", points: Points, polygons: Polygons) -> Any:
    """KLayout's network of a net; mirrored where its squares, counted as drawn, are more than MOST.

    It cuts a polygon into trapezoids, sometimes one without a height (1.3e11 ohm in xor2_2), and none of the mirrored.
    """
    candidates = []
    for view in (db.Trans(), db.Trans(db.Trans.M90)):  # as drawn, and mirrored
        seen = {layer: region.transformed(view) for layer, region in geometry.items()}
        spots = {layer: [view * point for point in same] for layer, same in points.items()}
        flat = {layer: [polygon.transformed(view) for polygon in same] for layer, same in polygons.items()}
        network = pex.RNetExtractor(dbu).extract(rules, seen, spots, flat)
        highest = max((element.resistance() for element in network.each_element()), default=0.0)
        if highest <= MOST:
            return network
        candidates.append((highest, network))
    return min(candidates, key=lambda view: view[0])[1]


def _reduced(
    network: Any, ports: Sequence[tuple[int, "db.Region | db.Point"]], flat: Polygons
) -> dict[tuple[int, int], float]:
    """Conductances between the ports (layer, shape), numbered in their order, and inner nodes, numbered from there."""
    number, count = {}, len(ports)
    for node in sorted(network.each_node(), key=lambda node: (node.layer(), str(node.location()))):  # not by address
        same = ((k, shape) for k, (layer, shape) in enumerate(ports) if node.layer() == layer)
        hit = next((k for k, shape in same if _is(node, shape, flat.get(node.layer(), ()))), None)
        number[node.object_id()] = count if hit is None else hit
        count += hit is None
    beside: list[dict[int, float]] = [{} for _ in range(count)]  # node -> neighbor: S
    ends = (((number[end.object_id()] for end in (e.a(), e.b())), e.resistance()) for e in network.each_element())
    for a, b, ohm in sorted((*sorted(pair), ohm) for pair, ohm in ends):
        _join(beside, a, b, 1 / max(ohm, LEAST))
    while inner := [k for k in range(len(ports), count) if 0 < len(beside[k]) <= BRANCHES]:
        _eliminate(beside, min(inner, key=lambda k: len(beside[k])))
    return {(a, b): conductance for a, same in enumerate(beside) for b, conductance in same.items() if a < b}


def _join(beside: list[dict[int, float]], a: int, b: int, conductance: float) -> None:
    if a != b:
        for side, other in ((a, b), (b, a)):
            beside[side][other] = beside[side].get(other, 0.0) + conductance


def _eliminate(beside: list[dict[int, float]], node: int) -> None:
    """Take ``node`` out: between each two of its neighbors its conductances' product over their sum (star to mesh)."""
    arms = beside[node]
    beside[node] = {}
    for other in arms:
        del beside[other][node]
    for (a, x), (b, y) in combinations(arms.items(), 2):
        _join(beside, a, b, x * y / sum(arms.values()))


def _is(node: Any, shape: "db.Region | db.Point", polygons: "Sequence[db.Polygon]") -> bool:
    """Return whether a network's node is the port ``shape``."""
    if isinstance(shape, db.Point):
        return node.type() == pex.RNode.VertexPort
    if node.type() != pex.RNode.PolygonPort:
        return False
    return not shape.interacting(db.Region(polygons[node.port_index()])).is_empty()
