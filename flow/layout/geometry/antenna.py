"""Antennas: the charge that a metal layer gathers while it is etched, and the gates that would have to bear it.

When a layer is etched, only the layers below join it to a gate or to a diffusion. The side walls of that layer on a
net, by the area of the net's gates, must stay below the process's ratio; a diffusion on the net raises it.
"""

from collections.abc import Collection, Iterator
from dataclasses import dataclass

from base.gds import db
from platforms.coriolis import CoriolisPlatform

SAFE = 1e9  # um2 of metal an um2 of diffusion, in the check of nets without one


@dataclass(frozen=True)
class Connected:
    """The nets of a layout up to a metal layer: gates, diffusions, metal of tech.metals up to that one."""

    l2n: "db.LayoutToNetlist"
    gate: "db.Region"
    diffusion: "db.Region"
    metals: "list[db.Region]"


def connected(
    layout: "db.Layout", top: "db.Cell", tech: CoriolisPlatform, levels: Collection[int]
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


def violations(
    layout: "db.Layout", top: "db.Cell", tech: CoriolisPlatform, levels: Collection[int] | None = None
) -> "dict[int, db.Region]":
    """Metal of the nets on which it is too large for their gates, by level of tech.metals; ``levels``: default all."""
    found = {}
    for nets in connected(layout, top, tech, range(len(tech.metals)) if levels is None else levels):
        level = len(nets.metals) - 1
        metal = tech.metals[level]
        base, more = metal.antenna_diffusion
        factors = (0.0, metal.thickness_um) if tech.antenna_walls else (1.0, 0.0)  # of the metal's area, its edges
        bad = db.Region()
        for ratio, by_diffusion in ((metal.antenna_ratio, SAFE), (base, more)):
            diodes = [[nets.diffusion, by_diffusion]]
            bad += nets.l2n.antenna_check(nets.gate, 1.0, 0.0, nets.metals[-1], *factors, ratio, diodes)
        found[level] = db.Region(list(bad.each()))  # no longer of the extraction, which goes on
    return found
