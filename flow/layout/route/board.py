"""A layout whose nets can be routed, ripped up and rerouted, net by net."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, TypedDict, TypeVar

import numpy as np

from talbot.base.gds import db

from ..geometry.boxes import Box, boxes, corners
from .grid import Grid
from .index import COLUMNS, Index, Links, Rows
from .route import Point, Route
from .rules import RoutingRules

FIXED, CONTENDED = -1, -2  # owners that are no net
# Cost of a net that has a place, in that of one conflict there before: at first, from turn to turn, at last
PRESENT, GROWTH, PRESENT_MOST = 4, 3, 200
HISTORY = 4  # conflicts that cost as much as a net that has a place
CUTS = 0  # level of `Board.fixed` that holds vias
Key = TypeVar("Key")


Owners = dict[tuple[str, Key], str]  # nets by layer and box or point


class NetShapes(TypedDict):
    """A net's segments, vias and, of every pin, the boxes of which any is to be met, as coriolis.dump has them (um)."""

    segments: list[list[Any]]
    vias: list[list[Any]]
    pins: list[list[list[Any]]]


class Board:
    """A KLayout layout with the shapes of the nets ``shapes`` lifted out into ``boxes``.

    What is left is fixed: cells, straps, ports. The shapes of a short belong to the earlier net. boxes: by net
    [(name of a layer of ``rules``, Box in nm), ...]. fixed: what is left, and on level 0 the cells' own vias above
    their pins; the owner of a box is FIXED or the number of the only net that may touch it. routed: the metal of all
    nets, and where nets CONTENDED. grid: both as places, of middles of segments within ``area`` (nm; default: wherever
    there is something). present: see PRESENT. weights: of nets, see `price`. diodes: by net and number of a diode's pin
    that of the gate's. jumpers: by net the numbers of pins that are met from the highest layer alone.
    """

    def __init__(
        self, layout: "db.Layout", rules: RoutingRules, shapes: Mapping[str, NetShapes], area: Box | None = None
    ) -> None:
        self.layout, self.rules, self.top = layout, rules, layout.top_cell()
        self.nets = list(shapes)
        self.boxes: dict[str, list[tuple[str, Box]]] = {net: [] for net in shapes}
        self.numbers = {net: number for number, net in enumerate(self.nets)}
        self.levels = {layer.name: level for level, layer in enumerate(rules.layers)}
        self.layers = {made.name: layout.layer(made.layer, made.datatype) for made in (*rules.layers, *rules.vias)}
        self.pins = {net: self._pins(made["pins"]) for net, made in shapes.items()}
        self._lift(shapes)
        area = area or corners(self.top.bbox().enlarged(*rules.step))
        whole = corners(self.top.bbox().enlarged(*rules.step) + db.Box(*area))
        self.fixed, self.routed = Index(whole, len(rules.layers)), Index(whole, len(rules.layers))
        self.grid = Grid(area, rules)
        self.rows: dict[str, tuple[Rows, Links]] = {}
        self.present = PRESENT
        self.weights: defaultdict[str, int] = defaultdict(lambda: 1)
        self.accesses: dict[str, dict[int, Any]] = {}  # by net and pin, see access
        self.diodes: defaultdict[str, dict[int, int]] = defaultdict(dict)
        self.jumpers: defaultdict[str, set[int]] = defaultdict(set)
        self._fix()
        for net in self.nets:
            self._enter(net)

    def _pins(self, made: list[list[list[Any]]]) -> list[list[tuple[int, ...]]]:
        """Of every pin of a net the boxes (level, left, bottom, right, top), nm."""
        return [[(self.levels[name], *nanometres(um)) for name, *um in pin] for pin in made]

    def pin_of(self, net: str, gate: Point) -> int:
        """Number of the pin of ``net`` nearest to a ``gate``, not of a diode."""
        pins = self.pins[net]
        own = (number for number in range(len(pins)) if number not in self.diodes[net])
        return min(own, key=lambda number: _distance(pins[number], gate))

    def add_diode(self, net: str, boxes: list[list[Any]], pin: int) -> None:
        """Give ``net`` a diode, a pin of ``boxes`` as in NetShapes, to be joined with its pin of that number."""
        self.diodes[net][len(self.pins[net])] = pin
        self.pins[net] += self._pins([boxes])

    def _lift(self, shapes: Mapping[str, NetShapes]) -> None:
        exact, middles, ports = _claims(shapes)
        for name, layer in self.layers.items():
            for shape in list(self.top.shapes(layer).each()):
                box = corners(shape.bbox())
                net = exact.get((name, box)) or middles.get((name, middle(box)))
                if net and not shape.is_text() and (name, box) not in ports:
                    self.boxes[net].append((name, box))
                    shape.delete()

    def _fix(self) -> None:
        """Enter what is left."""
        entered = []
        for level, layer in enumerate((self.rules.vias[0], *self.rules.layers[1:])):
            left = boxes(db.Region(self.top.begin_shapes_rec(self.layers[layer.name])))
            entered.append(self.fixed.insert(as_rows([(level, *box) for box in left.tolist()], FIXED)))
        for net, pins in self.pins.items():
            for level, left, bottom, right, top in (box for pin in pins for box in pin if box[0]):
                numbers = self.fixed.numbers(level, (left + 1, bottom + 1, right - 1, top - 1))
                self.fixed.boxes[numbers, -1] = self.numbers[net]
        rows = self.fixed.boxes[np.concatenate(entered)]
        self.grid.block(rows[rows[:, 0] > 0])

    def _enter(self, net: str) -> None:
        """Enter the shapes of ``net`` where others look for them."""
        made = [(self.levels[name], *box) for name, box in self.boxes[net] if name in self.levels]
        rows = as_rows(made, self.numbers[net])
        self.rows[net] = rows, self.routed.insert(rows)
        self.grid.use(rows[rows[:, 0] > 0], self.price(net))

    def add_history(self, places: Iterable[tuple[int, Box]]) -> None:
        """Raise the history cost of ``places``, pairs (level, Box)."""
        rows = as_rows([(level, *box) for level, box in places], CONTENDED)
        self.routed.insert(rows)
        self.grid.use(rows, self.conflict())

    def charge(self, present: int) -> None:
        """Let places that nets have cost others so much, at most PRESENT_MOST."""
        more = min(present, PRESENT_MOST) - self.present
        by_weight = defaultdict[int, list[Rows]](list)
        for net, (rows, _) in self.rows.items() if more else ():
            by_weight[self.weights[net]].append(rows)
        for weight, made in by_weight.items():
            rows = np.concatenate(made)
            self.grid.use(rows[rows[:, 0] > 0], more * weight)
        self.present += more

    def price(self, net: str) -> int:
        """What a place of ``net`` costs others: as much more as its weight."""
        return self.present * self.weights[net]

    def conflict(self) -> int:
        """What a conflict adds to the cost of a place."""
        return max(1, self.present // HISTORY)

    def rip_up(self, net: str) -> None:
        """Take the shapes of ``net`` off the board."""
        rows, numbers = self.rows[net]
        self.routed.remove(numbers)
        self.grid.use(rows[rows[:, 0] > 0], -self.price(net))
        self.boxes[net], self.rows[net] = [], (rows[:0], numbers[:0])

    def put(self, net: str, route: Route, weight: int | None = None) -> None:
        """Let the shapes of ``net`` be those of ``route``, its weight (`price`) ``weight``, as before without it."""
        self.rip_up(net)
        self.weights[net] = weight or self.weights[net]
        for level, made in route.segments.items():
            self.boxes[net] += [(self.rules.layers[level].name, box) for box in made]
        for level, points in route.vias.items():
            via = self.rules.vias[level]
            half = via.size // 2
            self.boxes[net] += [(via.name, (x - half, y - half, x + half, y + half)) for x, y in sorted(set(points))]
        self._enter(net)

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
        outlines = Index(corners(top.bbox()), 1)
        outlines.insert(np.array([(0, *corners(inst.bbox()), k) for k, inst in enumerate(top.each_inst())]))
        kept = set()
        for name, box in (made for net in nets for made in self.boxes[net]):
            around = box[0] - reach, box[1] - reach, box[2] + reach, box[3] + reach
            kept.update(outlines.touching(0, around)[:, -1].tolist())
            if name in self.levels:
                for *other, owner in self.routed.touching(self.levels[name], around).tolist():
                    if owner != CONTENDED:
                        found[name, tuple(other)] = True
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

    def owners(self, level: int, box: Box) -> set[int]:
        """Numbers of the nets with a segment that touches ``box``."""
        return set(self.routed.touching(level, box)[:, -1].tolist()) - {CONTENDED}

    def within(self, level: int, polygon: str) -> set[str]:
        """Names of the nets with a box whose middle is in ``polygon``, KLayout's text."""
        outline = db.Polygon.from_s(polygon)
        found = self.routed.touching(level, corners(outline.bbox())).tolist()
        inside = {owner for *box, owner in found if owner != CONTENDED and outline.inside(db.Point(*middle(box)))}
        return {self.nets[number] for number in inside}


def as_rows(made: Sequence[Sequence[int]], owner: int) -> Rows:
    """Rows for an Index, of (level, left, bottom, right, top)."""
    rows = np.full((len(made), COLUMNS), owner, np.int64)
    if made:
        rows[:, :-1] = made
    return rows


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


def _distance(pin: Sequence[Sequence[int]], point: Point) -> int:
    """From the nearest box of a pin to a point."""
    x, y = point
    return min(max(left - x, x - right, 0) + max(bottom - y, y - top, 0) for _, left, bottom, right, top in pin)


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
