"""Capacitances between the nets of a cell: areas, sidewalls and fringe fields (2.5-D).

A conductor's underside sees the nearest conductor below it, else well or substrate. An edge sees, on its own layer, the
nearest edge that faces it (coefficient * length / (distance + offset)); of its fringe field the part
2/pi * (atan(k far) - atan(k near)), k = 0.02 /um * the overlap coefficient in aF/um2, ends between the lateral
distances near and far (Magic's ExtCouple.c), on the nearest layer below or above; nothing ends beyond the edge that
faces it. Gates are left out over active: the transistor model has their capacitances.
"""

import math
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from talbot.base.gds import db
from talbot.cells.extract.devices import CellLayout
from talbot.platforms.extraction import ExtractionPlatform
from talbot.platforms.layers import DIFFUSION, Layer

EPSILON = 1e-6  # um
Span = tuple[float, float]  # distances near and far from an edge, um


class Rectangle(NamedTuple):
    """A rectangle of a net, um."""

    left: float
    bottom: float
    right: float
    top: float
    net: str


class Strip(NamedTuple):
    """Part of a rectangle outside an edge: distances from the edge and positions along it, um."""

    near: float
    far: float
    start: float
    end: float
    net: str


class _Total:
    """Sums of capacitances by pair of nets, fF; the names of the conductors and their crossings."""

    def __init__(self, tech: ExtractionPlatform) -> None:
        self.pairs: dict[tuple[str, str], float] = defaultdict(float)
        self.names = [conductor.lef for conductor in tech.conductors]
        self.crossings = {(c.upper, c.lower): c for c in tech.crossings}

    def add(self, a: str, b: str, attofarad: float) -> None:
        """Add the capacitance between ``a`` and ``b``; none of a net to itself."""
        if a != b:
            self.pairs[min(a, b), max(a, b)] += attofarad / 1000

    def below(self, layer: Layer) -> list[str]:
        """Conductors under ``layer``, the nearest first; diffusion under all."""
        return [*reversed(self.names[: self.names.index(layer.lef)]), DIFFUSION]


def capacitances(layout: CellLayout, tech: ExtractionPlatform) -> dict[tuple[str, str], float]:
    """Capacitance in fF of every pair of nets, the names of each pair sorted."""
    total, rectangles = _Total(tech), _Rectangles(layout, tech.halo_um)
    for layer in tech.conductors:
        for net, region in layout.shapes[layer.lef].items():
            _areas(layout, net, layer, region.merged(), total)
    for layer in tech.conductors:
        for net, region in layout.shapes[layer.lef].items():
            for edge in region.merged().edges().each():
                _edge(edge, net, layer, rectangles, total)
    return dict(total.pairs)


def _areas(layout: CellLayout, net: str, layer: Layer, exposed: "db.Region", total: _Total) -> None:
    um2 = layout.dbu**2
    for lower in total.below(layer):
        if layer.lef == "poly":
            exposed -= layout.active
            continue
        for other, below in layout.shapes[lower].items():
            if exposed.bbox().touches(below.bbox()):
                area = (exposed & below).area() * um2
                total.add(net, other, area * total.crossings[layer.lef, lower].overlap_af_um2)
                exposed -= below
    for bulk, well in layout.wells.items():
        total.add(net, bulk, (exposed & well).area() * um2 * layer.area_af_um2)


class _Rectangles:
    """The conductors, wells and active as rectangles, by layer."""

    def __init__(self, layout: CellLayout, halo_um: float) -> None:
        regions = {**layout.shapes, "well": layout.wells, "active": {"": layout.active}}
        self.layers = {name: _split(nets, layout.dbu) for name, nets in regions.items()}
        self.dbu, self.halo_um = layout.dbu, halo_um

    def beside(self, rectangles: Sequence[Rectangle], edge: "db.Edge") -> Iterator[Strip]:
        """Parts of ``rectangles`` in the strip of width ``halo_um`` outside ``edge``."""
        x1, y1, x2, y2 = (v * self.dbu for v in (edge.p1.x, edge.p1.y, edge.p2.x, edge.p2.y))
        vertical = x1 == x2
        # A hull runs clockwise: what is on the left of the edge is outside.
        sign = (-1 if y2 > y1 else 1) if vertical else (1 if x2 > x1 else -1)
        at, start, end = (x1, min(y1, y2), max(y1, y2)) if vertical else (y1, min(x1, x2), max(x1, x2))
        for left, bottom, right, top, net in rectangles:
            low, high, a, b = (left, right, bottom, top) if vertical else (bottom, top, left, right)
            near, far = ((low - at), (high - at)) if sign > 0 else ((at - high), (at - low))
            a, b, near, far = max(a, start), min(b, end), max(near, 0.0), min(far, self.halo_um)
            if b - a > EPSILON and far - near > EPSILON:
                yield Strip(near, far, a, b, net)


def _split(nets: "Mapping[str, db.Region]", dbu: float) -> list[Rectangle]:
    boxes = []
    for net, region in nets.items():
        for trapezoid in region.decompose_trapezoids_to_region().each():
            box = trapezoid.bbox()
            boxes.append(Rectangle(box.left * dbu, box.bottom * dbu, box.right * dbu, box.top * dbu, net))
    return boxes


def _edge(edge: "db.Edge", net: str, layer: Layer, rectangles: _Rectangles, total: _Total) -> None:
    """All that one edge of ``net`` on ``layer`` sees."""
    strips = {name: list(rectangles.beside(parts, edge)) for name, parts in rectangles.layers.items()}
    if layer.lef != "poly":
        strips["active"] = []
    start, end = sorted((edge.p1.y, edge.p2.y) if edge.p1.x == edge.p2.x else (edge.p1.x, edge.p2.x))
    ends = {start * rectangles.dbu, end * rectangles.dbu}
    for parts in strips.values():
        ends.update(v for strip in parts for v in (strip.start, strip.end))
    bounds = sorted(ends)
    for a, b in zip(bounds, bounds[1:]):
        length, low, high = b - a, a + EPSILON, b - EPSILON
        if length < EPSILON:
            continue
        across = {name: [s for s in parts if s.start <= low and s.end >= high] for name, parts in strips.items()}
        here = {name: [(s.near, s.far, s.net) for s in parts] for name, parts in across.items()}
        near, _, other = min(here[layer.lef], default=(rectangles.halo_um, 0, net))
        if other != net:
            total.add(net, other, length * layer.sidewall_af_um / 2 / (near + layer.sidewall_offset_um))
        free = [(0.0, near)]
        if not (here["active"] and min(here["active"])[0] < EPSILON):  # not along a channel
            _down(free, here, net, layer, length, total)
        for upper in total.names[total.names.index(layer.lef) + 1 :]:
            crossing = total.crossings[upper, layer.lef]
            for near, far, other in _pieces(free, here[upper]):
                total.add(net, other, length * crossing.up_af_um * _share(crossing.overlap_af_um2, near, far))
            free = _without(free, here[upper])


Intervals = list[tuple[float, float, str]]  # near, far, net


def _down(
    free: list[Span], here: Mapping[str, Intervals], net: str, layer: Layer, length: float, total: _Total
) -> None:
    for lower in total.below(layer):
        if layer.lef == "poly":
            free = _without(free, here["active"])
            continue
        crossing = total.crossings[layer.lef, lower]
        for near, far, other in _pieces(free, here[lower]):
            total.add(net, other, length * crossing.down_af_um * _share(crossing.overlap_af_um2, near, far))
        free = _without(free, here[lower])
    for near, far, bulk in _pieces(free, here["well"]):
        total.add(net, bulk, length * layer.fringe_af_um * _share(layer.area_af_um2, near, far))


def _share(overlap: float, near: float, far: float) -> float:
    k = 0.02 * overlap
    return 2 / math.pi * (math.atan(k * far) - math.atan(k * near))


def _pieces(free: Sequence[Span], intervals: Intervals) -> Iterator[tuple[float, float, str]]:
    """The parts of ``intervals`` in ``free``."""
    for near, far, net in intervals:
        for a, b in free:
            if min(b, far) > max(a, near):
                yield max(a, near), min(b, far), net


def _without(free: list[Span], intervals: Iterable[tuple[float, float, str]]) -> list[Span]:
    for near, far, _ in intervals:
        parts = [part for a, b in free for part in ((a, min(b, near)), (max(a, far), b))]
        free = [(a, b) for a, b in parts if b - a > EPSILON]
    return free
