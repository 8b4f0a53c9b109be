"""Resistance of contacts and wires between a net's pin, its sources and drains, and its gates.

KLayout's network extraction counts squares on every wire; a source or drain is one node, joined to the wire above by
its contacts (a p diffusion with one contact has 585 ohm before its transistor). Of the network's inner nodes those with
at most BRANCHES resistors are then taken out, which changes nothing for its terminals. Without any inner nodes a net of
n terminals has n^2 / 2 resistors, and buf_16 takes twice as long.
"""

from dataclasses import dataclass
from itertools import combinations

import klayout.db as db
from klayout import pex

from models.parameters import ParameterError
from platforms.layers import DIFFUSION

IDEAL = 1e-3  # ohm a square of a diffusion, in which the transistor's model has the resistance
LEAST = 1e-3  # ohm; what is less is as much
MOST = 1e6  # ohm; what is more is left out
BRANCHES = 5  # of a node that is taken out
VIEWS = (db.Trans(), db.Trans(db.Trans.M90))  # as drawn, and mirrored


@dataclass(frozen=True)
class Resistances:
    """resistors: [(node, node, ohm)]. terminals: device number -> {'drain', 'gate', 'source': node}. Nodes that are not

    in it have their net's name.
    """

    resistors: list
    terminals: dict


def resistances(found, tech):
    """Resistances of a Layout (cells.extract.devices)."""
    resistors, terminals = [], {i: {} for i in range(len(found.devices))}
    sides = {net: [] for net in {d for device in found.devices for d in (device.drain, device.gate, device.source)}}
    for i, device in enumerate(found.devices):
        for role, region in _sides(device, found).items():
            sides[getattr(device, role)].append((i, role, *region))
    for net in sorted(sides):
        ports = _ports(net, sides[net], found)
        nodes = [net, *(f"{net}_r{k}" for k in range(1, len(ports)))]
        for node, (_, _, users) in zip(nodes, ports, strict=True):
            for i, role in users:
                terminals[i][role] = node
        if len(ports) > 1:
            kept = {
                pair: siemens for pair, siemens in _conductances(net, ports, found, tech).items() if siemens > 1 / MOST
            }
            if set(range(len(ports))) - {end for pair in kept for end in pair}:
                raise ParameterError(f"net = {net}: no resistance below {MOST:g} ohm joins its {len(ports)} terminals")
            number = {k: node for k, node in enumerate(nodes)}
            for end in sorted({end for pair in kept for end in pair} - set(number)):
                number[end] = f"{net}_r{len(number)}"
            resistors += [(number[a], number[b], 1 / siemens) for (a, b), siemens in sorted(kept.items())]
    return Resistances(resistors, terminals)


def _sides(device, found):
    """role -> (layer, region) of a transistor: its gate's poly, the islands of its source and drain."""
    step = round(device.l / found.dbu / 2) + 10
    poly, gate = found.shapes["poly"][device.gate], db.Box(device.at, device.at).enlarged(5)
    sides = {"gate": ("poly", (poly & found.active).interacting(db.Region(gate)))}
    left, right = (_island(device, found, sign * step) for sign in (-1, 1))
    crossed = left[0] != device.source
    sides["source"], sides["drain"] = ((device.kind, side[1]) for side in ((right, left) if crossed else (left, right)))
    return sides


def _island(device, found, step):
    """(net, region) of the diffusion ``step`` dbu beside the middle of a gate."""
    spot = db.Region(db.Box(device.at, device.at).enlarged(2).moved(step, 0))
    for net, islands in found.islands[device.kind].items():
        part = islands.merged().interacting(spot)
        if not part.is_empty():
            return net, part
    raise AssertionError(f"no diffusion beside a gate of {device.gate}")


def _ports(net, sides, found):
    """[(layer, region or point, [(device number, role)])] of a net's terminals; its pin, if it has one, first."""
    ports = {}
    for i, role, layer, region in sides:
        key = layer, str(region.bbox())
        ports.setdefault(key, (layer, region, []))[2].append((i, role))
    ports = sorted(ports.values(), key=lambda port: (port[0] != "poly", str(port[1].bbox())))
    for wire, point in found.labels.get(net, ()):
        if not found.shapes[wire].get(net, db.Region()).interacting(_spot(point)).is_empty():
            return [(wire, point, []), *ports]
    return ports


def _spot(point):
    return db.Region(db.Box(point, point).enlarged(1))


def _conductances(net, ports, found, tech):
    """{(a, b): S} of ``net``: its ports, numbered in their order, and inner nodes, numbered from there."""
    names = ["n", "p", *(layer.lef for layer in tech.conductors)]
    number = {name: k for k, name in enumerate(names)}
    rules, geometry = pex.RExtractorTech(), {}
    for name in names:
        region = (found.islands[name] if name in found.islands else found.shapes[name]).get(net)
        if region is not None:
            geometry[number[name]] = region.merged()
            conductor = pex.RExtractorTechConductor()
            conductor.layer = number[name]
            conductor.resistance = IDEAL if name in found.islands else tech.conductor(name).sheet_ohm
            rules.add_conductor(conductor)
    for k, (region, via) in enumerate(zip(found.vias, tech.vias, strict=True)):
        for lower in [
            name for name in names if name in via.below or (name in found.islands and DIFFUSION in via.below)
        ]:
            if number[lower] in geometry and number[via.above] in geometry:
                _via(
                    rules,
                    geometry,
                    len(names) * (k + 1) + number[lower],
                    number[lower],
                    number[via.above],
                    region & geometry[number[lower]] & geometry[number[via.above]],
                    tech.contact_ohm[lower],
                )
    points, polygons = {}, {}
    for layer, shape, _ in ports:
        (points if isinstance(shape, db.Point) else polygons).setdefault(number[layer], []).append(shape)
    flat = {
        layer: [part for region in regions for part in region.merged().each()] for layer, regions in polygons.items()
    }
    network = _network(found.dbu, rules, geometry, points, flat)
    return _reduced(network, [(number[layer], shape) for layer, shape, _ in ports], flat)


def _network(dbu, tech, geometry, points, polygons):
    """KLayout's network of a net; mirrored where its squares, counted as drawn, come to more than MOST.

    It cuts a polygon into trapezoids, sometimes one without a height (1.3e11 ohm in xor2_2), and none of the mirrored.
    """
    found = []
    for view in VIEWS:
        network = pex.RNetExtractor(dbu).extract(
            tech,
            {layer: region.transformed(view) for layer, region in geometry.items()},
            {layer: [view * point for point in same] for layer, same in points.items()},
            {layer: [polygon.transformed(view) for polygon in same] for layer, same in polygons.items()},
        )
        highest = max((element.resistance() for element in network.each_element()), default=0.0)
        if highest <= MOST:
            return network
        found.append((highest, network))
    return min(found, key=lambda view: view[0])[1]


def _via(tech, geometry, layer, lower, upper, region, ohm):
    if region.is_empty():
        return
    geometry[layer] = region
    via = pex.RExtractorTechVia()
    via.cut_layer, via.bottom_conductor, via.top_conductor = layer, lower, upper
    area = region.area() / region.count() * 1e-6
    via.resistance = ohm * area
    tech.add_via(via)


def _reduced(network, ports, flat):
    """{(a, b): S} between the ports ((layer, shape)), numbered in their order, and inner nodes, numbered from there."""
    number, count = {}, len(ports)
    for node in sorted(network.each_node(), key=lambda node: (node.layer(), str(node.location()))):  # not by address
        hit = next(
            (
                k
                for k, (layer, shape) in enumerate(ports)
                if node.layer() == layer and _is(node, shape, flat.get(layer))
            ),
            None,
        )
        number[node.object_id()] = count if hit is None else hit
        count += hit is None
    beside = [{} for _ in range(count)]  # node -> neighbour: S
    for a, b, ohm in sorted(
        (*sorted((number[e.a().object_id()], number[e.b().object_id()])), e.resistance())
        for e in network.each_element()
    ):
        _join(beside, a, b, 1 / max(ohm, LEAST))
    while inner := [k for k in range(len(ports), count) if 0 < len(beside[k]) <= BRANCHES]:
        _eliminate(beside, min(inner, key=lambda k: len(beside[k])))
    return {(a, b): conductance for a, same in enumerate(beside) for b, conductance in same.items() if a < b}


def _join(beside, a, b, conductance):
    if a != b:
        for one, other in ((a, b), (b, a)):
            beside[one][other] = beside[one].get(other, 0.0) + conductance


def _eliminate(beside, node):
    """Take ``node`` out: between each two of its neighbours its conductances' product over their sum (star to mesh)."""
    arms = beside[node]
    beside[node] = {}
    for other in arms:
        del beside[other][node]
    for (a, x), (b, y) in combinations(arms.items(), 2):
        _join(beside, a, b, x * y / sum(arms.values()))


def _is(node, shape, polygons):
    """Whether a network's node is the port ``shape``."""
    if isinstance(shape, db.Point):
        return node.type() == pex.RNode.VertexPort
    if node.type() != pex.RNode.PolygonPort:
        return False
    return not shape.interacting(db.Region(polygons[node.port_index()])).is_empty()
