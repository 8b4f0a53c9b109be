"""The conductors of a layout as rectangles, and what connects them."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from talbot.base.gds import db
from talbot.models.compiled import njit
from talbot.platforms.extraction import ExtractionPlatform
from talbot.platforms.layers import DIFFUSION
from talbot.platforms.layout import LayoutPlatform
from talbot.platforms.wires import SUBSTRATE
from talbot.signoff.parasitics.bins import Bins, Ints, at, binned

BIN_UM = 1.0
DIFFUSION_LEVEL, POLY_LEVEL, METAL_LEVEL = 1, 2, 3  # the substrate is 0
Labels = dict[str, list[tuple[int, int, int]]]  # text -> (level, x, y), dbu


@dataclass(frozen=True)
class Shapes:
    """Rectangles that do not overlap on a level, and the points where they connect.

    dbu: um. names: of the levels. boxes: (n, 4) left, bottom, right, top, dbu. levels, nets: of each box; a net is a
    number from 0. links: (m, 5) box, box, x, y, and the level of the lower one of a via, or -1 where two boxes touch.
    """

    dbu: float
    names: tuple[str, ...]
    boxes: Ints
    levels: Ints
    nets: Ints
    links: Ints
    bins: Bins

    @property
    def net_count(self) -> int:
        """Number of nets."""
        return int(self.nets.max()) + 1

    def at(self, level: int, x: int, y: int) -> int:
        """The box of ``level`` around a point (dbu), or -1."""
        return at(self.boxes, self.levels, self.bins, level, x, y)


def level_names(tech: LayoutPlatform) -> tuple[str, ...]:
    """LEF names of the levels, from the substrate up."""
    return (SUBSTRATE, DIFFUSION, "poly", *(metal.lef for metal in tech.metals))


def shapes(layout: "db.Layout", cell: "db.Cell", tech: LayoutPlatform, devices: ExtractionPlatform) -> Shapes:
    """The conductors of ``cell`` and all below it; trapezoids that are no rectangles as the boxes around them."""

    def region(*layers: tuple[int, int]) -> "db.Region":
        found = db.Region()
        for layer in layers:
            found.insert(cell.begin_shapes_rec(layout.layer(*layer)))
        return found

    poly = region(tech.poly).merged()
    active = region(*(devices.devices[name] for name in ("diff", "tap") if name in devices.devices))
    conductors = [active - poly, poly, *(region(metal.gds).merged() for metal in tech.metals)]
    parts = [_boxes(conductor.decompose_trapezoids_to_region()) for conductor in conductors]
    boxes = np.concatenate(parts)
    levels = np.repeat(np.arange(1, len(parts) + 1, dtype=np.int32), [len(part) for part in parts])
    bins = binned(boxes, round(BIN_UM / layout.dbu))
    cuts = [_boxes(region(layer)) for layer in (tech.contact, *(via.gds for via in tech.vias))]
    links = [_touching(boxes, levels, bins)]
    for level, cut in enumerate(cuts, POLY_LEVEL):
        below = (POLY_LEVEL, DIFFUSION_LEVEL) if level == POLY_LEVEL else (level, level)
        links.append(_joined(boxes, levels, bins, cut, below[0], below[1], level + 1))
    found = np.concatenate(links)
    graph = coo_array((np.ones(len(found), np.int8), (found[:, 0], found[:, 1])), shape=(len(boxes), len(boxes)))
    nets = connected_components(graph, directed=False)[1].astype(np.int32)
    return Shapes(layout.dbu, level_names(tech), boxes, levels, nets, found, bins)


def labels(layout: "db.Layout", cell: "db.Cell", tech: LayoutPlatform) -> Labels:
    """The texts of ``cell`` itself on the layers of pins and labels of the metals."""
    found: Labels = {}
    for level, metal in enumerate(tech.metals, METAL_LEVEL):
        for layer in (metal.pin, metal.label):
            for shape in cell.shapes(layout.layer(*layer)).each(db.Shapes.STexts):
                found.setdefault(shape.text_string, []).append((level, shape.text.x, shape.text.y))
    return found


def _boxes(region: "db.Region") -> Ints:
    found = [(box.left, box.bottom, box.right, box.top) for box in (polygon.bbox() for polygon in region.each())]
    return np.array(found, np.int32).reshape(-1, 4)


@njit(cache=True)
def _touching(boxes: Ints, levels: Ints, bins: Bins) -> Ints:
    """Links between boxes of one level that have part of a side in common."""
    found = []
    for place in range(bins.columns * bins.rows):
        ids = bins.ids[bins.first[place] : bins.first[place + 1]]
        for i in range(len(ids)):
            for j in range(i):
                a, b = ids[i], ids[j]
                if levels[a] != levels[b]:
                    continue
                left, right = max(boxes[a, 0], boxes[b, 0]), min(boxes[a, 2], boxes[b, 2])
                bottom, top = max(boxes[a, 1], boxes[b, 1]), min(boxes[a, 3], boxes[b, 3])
                if left > right or bottom > top or (left == right and bottom == top):
                    continue
                here = (left - bins.left) // bins.side * bins.rows + (bottom - bins.bottom) // bins.side
                if here == place:
                    found.append((a, b, (left + right) // 2, (bottom + top) // 2))
    links = np.empty((len(found), 5), np.int32)
    for n, (a, b, x, y) in enumerate(found):
        links[n] = np.array((a, b, x, y, -1), np.int32)
    return links


@njit(cache=True)
def _joined(boxes: Ints, levels: Ints, bins: Bins, cuts: Ints, lower: int, lowest: int, upper: int) -> Ints:
    """Links through ``cuts``, from what is below each, on ``lower`` or else ``lowest``, to ``upper``."""
    links = np.empty((len(cuts), 5), np.int32)
    count = 0
    for n in range(len(cuts)):
        x, y = (cuts[n, 0] + cuts[n, 2]) // 2, (cuts[n, 1] + cuts[n, 3]) // 2
        a, b = at(boxes, levels, bins, lower, x, y), at(boxes, levels, bins, upper, x, y)
        if a < 0:
            a = at(boxes, levels, bins, lowest, x, y)
        if a >= 0 and b >= 0:
            links[count] = np.array((a, b, x, y, lower), np.int32)
            count += 1
    return links[:count]
