"""Stray capacitances between the nets of a cell: areas, sidewalls and fringe fields (2.5-D).

A wire's underside sees the nearest conductor below it, else well or substrate. An edge sees, on its own layer, the
nearest edge that faces it (coefficient * length / (distance + offset)); of its fringe field the part
2/pi * (atan(k far) - atan(k near)), k = 0.02 /um * the overlap coefficient in aF/um2, lands between the lateral
distances near and far (Magic's ExtCouple.c), on the nearest layer below or above; nothing lands beyond the edge that
faces it. Gates are left out over active: the transistor model has their capacitances.
"""

import math
from collections import defaultdict

from platforms.layers import DIFFUSION


def capacitances(found, tech):
    """{(net, net): fF}, the names of each pair sorted. found: cells.extract.devices.Layout."""
    total = defaultdict(float)

    def add(a, b, attofarad):
        if a != b:
            total[min(a, b), max(a, b)] += attofarad / 1000

    crossings = {(c.upper, c.lower): c for c in tech.crossings}
    _areas(found, tech, crossings, add)
    strips = _Rectangles(found)
    for wire in tech.conductors:
        for net, region in found.shapes[wire.lef].items():
            for edge in region.merged().edges().each():
                _edge(edge, net, wire, strips, tech, crossings, add)
    return dict(total)


def _below(wire, tech):
    """Conductors under ``wire``, the nearest first; diffusion under all."""
    names = [w.lef for w in tech.conductors]
    return [*reversed(names[: names.index(wire.lef)]), DIFFUSION]


def _areas(found, tech, crossings, add):
    um2 = found.dbu**2
    for wire in tech.conductors:
        for net, region in found.shapes[wire.lef].items():
            rest = region.merged()
            for lower in _below(wire, tech):
                if wire.lef == "poly":
                    rest -= found.active
                    continue
                for other, below in found.shapes[lower].items():
                    if rest.bbox().touches(below.bbox()):
                        area = (rest & below).area() * um2
                        add(net, other, area * crossings[wire.lef, lower].overlap_af_um2)
                        rest -= below
            for bulk, well in found.wells.items():
                add(net, bulk, (rest & well).area() * um2 * wire.area_af_um2)


class _Rectangles:
    """The conductors as rectangles in um, by layer: (left, bottom, right, top, net)."""

    def __init__(self, found):
        self.layers = {name: _split(nets, found.dbu) for name, nets in found.shapes.items()}
        self.wells = _split(found.wells, found.dbu)
        self.active = _split({"": found.active}, found.dbu)
        self.dbu = found.dbu

    def beside(self, rectangles, edge, halo):
        """Rectangles in the strip of width ``halo`` outside ``edge``, as (near, far, start, end, net): distances from

        the edge and positions along it, um.
        """
        x1, y1, x2, y2 = (v * self.dbu for v in (edge.p1.x, edge.p1.y, edge.p2.x, edge.p2.y))
        vertical = x1 == x2
        # A hull runs clockwise: what is on the left of the edge is outside.
        sign = (-1 if y2 > y1 else 1) if vertical else (1 if x2 > x1 else -1)
        at, start, end = (x1, min(y1, y2), max(y1, y2)) if vertical else (y1, min(x1, x2), max(x1, x2))
        for left, bottom, right, top, net in rectangles:
            low, high, a, b = (left, right, bottom, top) if vertical else (bottom, top, left, right)
            near, far = ((low - at), (high - at)) if sign > 0 else ((at - high), (at - low))
            a, b, near, far = max(a, start), min(b, end), max(near, 0.0), min(far, halo)
            if b - a > 1e-6 and far - near > 1e-6:
                yield near, far, a, b, net


def _split(nets, dbu):
    found = []
    for net, region in nets.items():
        for trapezoid in region.decompose_trapezoids_to_region().each():
            box = trapezoid.bbox()
            found.append((box.left * dbu, box.bottom * dbu, box.right * dbu, box.top * dbu, net))
    return found


def _edge(edge, net, wire, strips, tech, crossings, add):
    """All that one edge of ``net`` on ``wire`` sees."""
    names = [w.lef for w in tech.conductors]
    own = names.index(wire.lef)
    layers = {name: list(strips.beside(strips.layers[name], edge, tech.halo_um)) for name in [*names, DIFFUSION]}
    wells = list(strips.beside(strips.wells, edge, tech.halo_um))
    active = list(strips.beside(strips.active, edge, tech.halo_um)) if wire.lef == "poly" else []
    start, end = sorted((edge.p1.y, edge.p2.y) if edge.p1.x == edge.p2.x else (edge.p1.x, edge.p2.x))
    cuts = {start * strips.dbu, end * strips.dbu}
    for rectangles in (*layers.values(), wells, active):
        cuts.update(v for r in rectangles for v in r[2:4])
    cuts = sorted(cuts)
    for a, b in zip(cuts, cuts[1:]):
        length = b - a
        if length < 1e-6:
            continue
        here = {
            name: [(r[0], r[1], r[4]) for r in rectangles if r[2] <= a + 1e-6 and r[3] >= b - 1e-6]
            for name, rectangles in (*layers.items(), ("well", wells), ("active", active))
        }
        facing = min(here[wire.lef], default=(tech.halo_um, 0, net))
        add(
            net,
            facing[2],
            length * wire.sidewall_af_um / 2 / (facing[0] + wire.sidewall_offset_um) if facing[2] != net else 0.0,
        )
        free = [(0.0, facing[0])]
        if not (here["active"] and min(here["active"])[0] < 1e-6):  # not along a channel
            _down(free, here, net, wire, names[:own], length, crossings, add)
        _up(free, here, net, wire, names[own + 1 :], length, crossings, add)


def _down(free, here, net, wire, below, length, crossings, add):
    for lower in [*reversed(below), DIFFUSION]:
        if wire.lef == "poly":
            free = _without(free, here["active"])
            continue
        crossing = crossings[wire.lef, lower]
        for near, far, other in _pieces(free, here[lower]):
            add(net, other, length * crossing.down_af_um * _share(crossing.overlap_af_um2, near, far))
        free = _without(free, here[lower])
    for near, far, bulk in _pieces(free, here["well"]):
        add(net, bulk, length * wire.fringe_af_um * _share(wire.area_af_um2, near, far))


def _up(free, here, net, wire, above, length, crossings, add):
    for upper in above:
        crossing = crossings[upper, wire.lef]
        for near, far, other in _pieces(free, here[upper]):
            add(net, other, length * crossing.up_af_um * _share(crossing.overlap_af_um2, near, far))
        free = _without(free, here[upper])


def _share(overlap, near, far):
    k = 0.02 * overlap
    return 2 / math.pi * (math.atan(k * far) - math.atan(k * near))


def _pieces(free, intervals):
    """The parts of ``intervals`` (near, far, net) in ``free`` (near, far)."""
    for near, far, net in intervals:
        for a, b in free:
            if min(b, far) > max(a, near):
                yield max(a, near), min(b, far), net


def _without(free, intervals):
    for near, far, _ in intervals:
        free = [part for a, b in free for part in ((a, min(b, near)), (max(a, far), b)) if part[1] - part[0] > 1e-6]
    return free
