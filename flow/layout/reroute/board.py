"""A routed layout whose nets can be ripped up and rerouted, net by net."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, TypedDict, TypeVar

import numpy as np
import numpy.typing as npt
from numba import njit

from base.gds import db

from ..geometry.boxes import Box, Boxes, boxes, corners
from .route import Point, Route
from .rules import RoutingRules

BOX_AND_NET = 5  # columns
Key = TypeVar("Key")
Layers = dict[int, Boxes]  # boxes by level of RoutingRules.layers


Owners = dict[tuple[str, Key], str]  # nets by layer and box or point


class NetShapes(TypedDict):
    """A net's segments, vias and, of every pin, the boxes of which any is to be met, as coriolis.dump has them (um)."""

    segments: list[list[Any]]
    vias: list[list[Any]]
    pins: list[list[list[Any]]]


class Board:
    """A KLayout layout with the shapes of the nets ``shapes`` lifted out into ``boxes``.

    What is left is fixed: cells, straps, ports. The shapes of a short belong to the earlier net. boxes: by net
    [(name of a layer of ``rules``, Box in nm), ...]. routed[level]: array (n, 5) of the same on a metal layer, the last
    column the net's place in ``nets``. fixed[level]: array (n, 4). history[level]: array (n, 4) of the places that nets
    contended for, as often as they did. cuts: array (n, 4) of the cells' own vias above their pins.
    """

    def __init__(self, layout: "db.Layout", rules: RoutingRules, shapes: Mapping[str, NetShapes]) -> None:
        self.layout, self.rules, self.top = layout, rules, layout.top_cell()
        self.nets = list(shapes)
        self.boxes: dict[str, list[tuple[str, Box]]] = {net: [] for net in shapes}
        self.numbers = {net: number for number, net in enumerate(self.nets)}
        self.levels = {layer.name: level for level, layer in enumerate(rules.layers)}
        self.layers = {made.name: layout.layer(made.layer, made.datatype) for made in (*rules.layers, *rules.vias)}
        self._lift(shapes)
        self.routed: Layers = {level: self._owned(name) for name, level in self.levels.items()}
        left = {level: self.top.begin_shapes_rec(self.layers[name]) for name, level in self.levels.items() if level}
        self.fixed: Layers = {level: boxes(db.Region(shapes)) for level, shapes in left.items()}
        self.cuts: Boxes = boxes(db.Region(self.top.begin_shapes_rec(self.layers[rules.vias[0].name])))
        self.history: Layers = {level: np.empty((0, 4), int) for level in self.fixed}

    def _lift(self, shapes: Mapping[str, NetShapes]) -> None:
        exact, middles, ports = _claims(shapes)
        for name, layer in self.layers.items():
            for shape in list(self.top.shapes(layer).each()):
                box = corners(shape.bbox())
                net = exact.get((name, box)) or middles.get((name, middle(box)))
                if net and not shape.is_text() and (name, box) not in ports:
                    self.boxes[net].append((name, box))
                    shape.delete()

    def _owned(self, name: str) -> Boxes:
        """Boxes of all nets on a layer, each with the net's number: (n, 5)."""
        found = [(*box, self.numbers[net]) for net, made in self.boxes.items() for at, box in made if at == name]
        return np.array(found, int).reshape(-1, BOX_AND_NET)

    def add_history(self, places: Iterable[tuple[int, Box]]) -> None:
        """Raise the history cost of ``places``, pairs (level, Box)."""
        for level, box in places:
            self.history[level] = np.vstack([self.history[level], box])

    def rip_up(self, net: str) -> None:
        """Take the shapes of ``net`` off the board."""
        self.boxes[net] = []
        for level, routed in self.routed.items():
            self.routed[level] = routed[routed[:, 4] != self.numbers[net]]

    def put(self, net: str, route: Route) -> None:
        """Let the shapes of ``net`` be those of ``route``."""
        self.rip_up(net)
        for level, made in route.segments.items():
            self.boxes[net] += [(self.rules.layers[level].name, box) for box in made]
            owned = np.array([(*box, self.numbers[net]) for box in made], int)
            self.routed[level] = np.vstack([self.routed[level], owned])
        for level, points in route.vias.items():
            via = self.rules.vias[level]
            half = via.size // 2
            self.boxes[net] += [(via.name, (x - half, y - half, x + half, y + half)) for x, y in sorted(set(points))]

    def drawn(self) -> "db.Layout":
        """A new layout with the shapes of all nets in it."""
        layout = self.layout.dup()
        shapes = {name: layout.top_cell().shapes(layer) for name, layer in self.layers.items()}
        for net in self.nets:
            for name, box in self.boxes[net]:
                shapes[name].insert(db.Box(*box))
        return layout

    def part(self, nets: Iterable[str]) -> "db.Layout":
        """A new layout with the shapes of ``nets``, what of others is near to these, and the cells below alone."""
        layout, found = self.layout.dup(), {}
        top, reach = layout.top_cell(), max(layer.space for layer in self.rules.layers)
        below = [inst.cell_inst for inst in top.each_inst()]
        outlines = [corners(inst.bbox()) for inst in top.each_inst()]
        places = np.array([(*box, number) for number, box in enumerate(outlines)], int).reshape(-1, BOX_AND_NET)
        kept = set()
        for name, box in (made for net in nets for made in self.boxes[net]):
            around = box[0] - reach, box[1] - reach, box[2] + reach, box[3] + reach
            kept.update(overlapping(places, around)[:, 4].tolist())
            if name in self.levels:
                for row in overlapping(self.routed[self.levels[name]], around).tolist():
                    found[name, tuple(row[:4])] = True
            found[name, box] = True
        top.clear_insts()
        for number in sorted(kept):
            top.insert(below[number])
        for name, box in found:
            top.shapes(self.layers[name]).insert(db.Box(*box))
        for cell in layout.top_cells():
            if cell.cell_index() != top.cell_index():
                cell.prune_cell()
        return layout

    def touching(self, nets: Iterable[str]) -> set[str]:
        """Names of all nets with a segment that touches one of ``nets``, these too."""
        boxes = [(self.levels[name], box) for net in nets for name, box in self.boxes[net] if name in self.levels]
        return {self.nets[number] for level, box in boxes for number in self.owners(self.routed, level, box)}

    def owners(self, routed: Layers, level: int, box: Box) -> list[int]:
        """Numbers of the nets with a segment that touches ``box``; routed: this board's, now or earlier."""
        return overlapping(routed[level], box)[:, 4].tolist()

    def within(self, routed: Layers, level: int, polygon: str) -> set[str]:
        """Names of the nets with a box whose middle is in ``polygon``, KLayout's text; routed: see `owners`."""
        outline = db.Polygon.from_s(polygon)
        found = overlapping(routed[level], corners(outline.bbox())).tolist()
        return {self.nets[number] for *ends, number in found if outline.inside(db.Point(*middle(ends)))}


def overlapping(boxes: Boxes, box: Box) -> Boxes:
    """Rows of ``boxes``, (left, bottom, right, top, ...), that touch ``box``."""
    return boxes[_touching(boxes, *map(int, box))]


@njit(cache=True)
def _touching(boxes: Boxes, left: int, bottom: int, right: int, top: int) -> npt.NDArray[np.int64]:
    """Numbers of these rows."""
    found = np.empty(len(boxes), np.int64)
    count = 0
    for k in range(len(boxes)):
        if boxes[k, 0] <= right and boxes[k, 2] >= left and boxes[k, 1] <= top and boxes[k, 3] >= bottom:
            found[count] = k
            count += 1
    return found[:count]


def _claims(shapes: Mapping[str, NetShapes]) -> tuple[Owners[Box], Owners[Point], set[tuple[str, Box]]]:
    """Return who owns a shape: nets by (layer, box) of a segment and by (layer, middle) of a pad or via; the pins.

    Pads are in the middles of vias and at the ends of segments.
    """
    exact, middles, ports = {}, {}, set()
    for net, made in shapes.items():
        for name, *um in made["segments"]:
            box = nanometres(um)
            exact.setdefault((name, box), net)
            for point in (middle(box), *_ends(box)):
                middles.setdefault((name, point), net)
        for name, x, y in made["vias"]:
            for part in name.split("_"):
                middles.setdefault((part, nanometres((x, y))), net)
        ports |= {(name, nanometres(box)) for pin in made["pins"] for name, *box in pin}
    return exact, middles, ports


def middle(box: Sequence[int]) -> Point:
    """Return the middle of a box, rounded down."""
    return (box[0] + box[2]) // 2, (box[1] + box[3]) // 2


def _ends(box: Box) -> tuple[Point, Point]:
    """Middles of the two ends of a segment."""
    (left, bottom, right, top), (x, y) = box, middle(box)
    return ((left, y), (right, y)) if right - left > top - bottom else ((x, bottom), (x, top))


def nanometres(values: Sequence[float]) -> Any:
    """Round um to nm: a tuple as long as ``values``."""
    return tuple(round(1000 * value) for value in values)
