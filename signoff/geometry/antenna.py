"""Antennas: the charge that a metal layer gathers while it is etched, and the gates that would have to bear it.

When a layer is etched, only the layers below join it to a gate or to a diffusion. The side walls of that layer on a
net, by the area of the net's gates, must stay below the process's ratio; a diffusion on the net raises it.
"""

from collections.abc import Collection, Iterator
from dataclasses import dataclass

from talbot.base.gds import db
from talbot.platforms.layout import LayoutPlatform
from talbot.signoff.geometry.boxes import Box, corners

SAFE = 1e9  # um2 of metal an um2 of diffusion, in the check of nets without one


@dataclass(frozen=True)
class Connected:
    """The nets of a layout up to a metal layer: gates, diffusions, metal of tech.metals up to that one."""

    l2n: "db.LayoutToNetlist"
    gate: "db.Region"
    diffusion: "db.Region"
    metals: "list[db.Region]"


def connected(
    layout: "db.Layout", top: "db.Cell", tech: LayoutPlatform, levels: Collection[int]
) -> Iterator[Connected]:
    """Yield the nets joined by the layers up to each of ``levels``. One is void as soon as the next is asked for."""
    l2n = db.LayoutToNetlist(db.RecursiveShapeIterator(layout, top, []))
    named = (("poly", tech.poly), ("active", tech.active), ("contact", tech.contact))
    poly, active, contact = (l2n.make_polygon_layer(layout.layer(*pair), name) for name, pair in named)
    gate, diffusion = poly & active, active - poly
    l2n.register(gate, "gate")
    l2n.register(diffusion, "diffusion")
    joined = (poly, poly), (contact, contact), (poly, contact), (gate, gate), (diffusion, diffusion), (poly, gate)
    for a, b in (*joined, (diffusion, contact)):
        l2n.connect(a, b)
    below, metals = contact, []
    for level, metal in enumerate(tech.metals):
        metals.append(l2n.make_polygon_layer(layout.layer(metal.layer, metal.datatype), metal.name))
        l2n.connect(metals[-1])
        l2n.connect(below, metals[-1])
        if level in levels:
            l2n.extract_netlist()
            yield Connected(l2n, gate, diffusion, list(metals))
            l2n.reset_extracted()
        if level < len(tech.vias):
            via = tech.vias[level]
            below = l2n.make_polygon_layer(layout.layer(via.layer, via.datatype), via.name)
            l2n.connect(below)
            l2n.connect(metals[-1], below)


def metal_beyond(nets: Connected, tech: LayoutPlatform) -> "db.Region":
    """Metal of the highest of ``nets``'s layers that is too large for the gates of its net."""
    metal = tech.metals[len(nets.metals) - 1]
    base, more = metal.antenna_diffusion
    factors = (0.0, metal.thickness_um) if tech.antenna_walls else (1.0, 0.0)  # of the metal's area, its edges
    bad = db.Region()
    for ratio, by_diffusion in ((metal.antenna_ratio, SAFE), (base, more)):
        diodes = [[nets.diffusion, by_diffusion]]
        bad += nets.l2n.antenna_check(nets.gate, 1.0, 0.0, nets.metals[-1], *factors, ratio, diodes)
    found = db.Region(list(bad.each()))  # no longer of the extraction, which goes on
    found.remove_properties()  # texts of how it was found
    return found


def violations(
    layout: "db.Layout", top: "db.Cell", tech: LayoutPlatform, levels: Collection[int] | None = None
) -> "dict[int, db.Region]":
    """Metal of the nets on which it is too large for their gates, by level of tech.metals; ``levels``: default all."""
    every = range(len(tech.metals)) if levels is None else levels
    return {len(nets.metals) - 1: metal_beyond(nets, tech) for nets in connected(layout, top, tech, every)}


def charged(
    layout: "db.Layout", top: "db.Cell", tech: LayoutPlatform, levels: Collection[int]
) -> list[tuple[int, str, tuple[Box, ...]]]:
    """What `violations` finds: the level, the metal as KLayout writes a polygon, the gates (dbu) that it charges."""
    found = []
    for nets in connected(layout, top, tech, levels):
        for polygon in metal_beyond(nets, tech).each():
            net = nets.l2n.probe_net(nets.metals[-1], inside(polygon))
            gates = nets.l2n.shapes_of_net(net, nets.gate, True)
            found.append((len(nets.metals) - 1, str(polygon), tuple(corners(gate.bbox()) for gate in gates.each())))
    return found


def inside(polygon: "db.Polygon") -> "db.Point":
    """A point inside."""
    return polygon.decompose_trapezoids()[0].bbox().center()
