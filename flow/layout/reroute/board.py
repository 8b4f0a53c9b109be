"""A routed layout whose wires can be taken out and drawn anew, net by net."""

import numpy as np
from numba import njit

from ..geometry.boxes import boxes

BOX_AND_NET = 5  # columns


class Board:
    """layout: KLayout's; lifted from it, into ``boxes``, is what belongs to the nets ``shapes``, and what is left
    stands for good: cells, straps, ports.

    shapes: dict net -> as coriolis.dump has them; the shapes of a short are the former net's. boxes: dict net ->
    [(name of a layer of ``wiring``, (left, bottom, right, top) in nm), ...]. there[level]: array (n, 5) of the same on a wire's
    level, the last column the net's place in ``nets``. fixed[level]: array (n, 4) of what stands.
    scars[level]: array (n, 4) of the places that nets have fought over, as often as they did.
    """

    def __init__(self, layout, wiring, shapes):
        self.layout, self.wiring, self.top = layout, wiring, layout.top_cell()
        self.nets, self.boxes = list(shapes), {net: [] for net in shapes}
        self.numbers = {net: number for number, net in enumerate(self.nets)}
        self.levels = {layer.name: level for level, layer in enumerate(wiring.layers)}
        self.layers = {made.name: layout.layer(made.layer, made.datatype) for made in (*wiring.layers, *wiring.cuts)}
        self._lift(shapes)
        self.there = {level: self._owned(name) for name, level in self.levels.items()}
        self.fixed = {level: self._standing(name) for name, level in self.levels.items() if level}
        self.scars = {level: np.empty((0, 4), int) for level in self.fixed}

    def _lift(self, shapes):
        exact, middles, ports = _claims(shapes)
        for name, layer in self.layers.items():
            for shape in list(self.top.shapes(layer).each()):
                box = shape.bbox()
                ends = box.left, box.bottom, box.right, box.top
                net = exact.get((name, ends)) or middles.get((name, middle(ends)))
                if net and not shape.is_text() and (name, ends) not in ports:
                    self.boxes[net].append((name, ends))
                    shape.delete()

    def _owned(self, name):
        """Boxes of all nets on a layer, each with the net's number: (n, 5)."""
        found = [(*box, self.numbers[net]) for net, made in self.boxes.items() for at, box in made if at == name]
        return np.array(found, int).reshape(-1, BOX_AND_NET)

    def fought(self, places):
        """Remember that nets fought over ``places``, [(level, box), ...]."""
        for level, box in places:
            self.scars[level] = np.vstack([self.scars[level], box])

    def _standing(self, name):
        """Boxes (n, 4) of what is left on a layer, in the cells, too."""
        import klayout.db as db

        return boxes(db.Region(self.top.begin_shapes_rec(self.layers[name])))

    def take(self, net):
        """Take the wires of ``net`` out of what is there."""
        self.boxes[net] = []
        for level, there in self.there.items():
            self.there[level] = there[there[:, 4] != self.numbers[net]]

    def put(self, net, shapes):
        """Let the wires of ``net`` be the Shapes ``shapes``."""
        self.take(net)
        for level, made in shapes.wires.items():
            self.boxes[net] += [(self.wiring.layers[level].name, box) for box in made]
            owned = np.array([(*box, self.numbers[net]) for box in made], int)
            self.there[level] = np.vstack([self.there[level], owned])
        for level, points in shapes.cuts.items():
            cut = self.wiring.cuts[level]
            half = cut.size // 2
            self.boxes[net] += [(cut.name, (x - half, y - half, x + half, y + half)) for x, y in sorted(set(points))]

    def drawn(self):
        """A layout of its own with the wires of all nets in it."""
        import klayout.db as db

        layout = self.layout.dup()
        shapes = {name: layout.top_cell().shapes(layer) for name, layer in self.layers.items()}
        for net in self.nets:
            for name, box in self.boxes[net]:
                shapes[name].insert(db.Box(*box))
        return layout

    def part(self, nets):
        """The same with the wires of ``nets``, what of others comes near to these, and the cells below alone."""
        import klayout.db as db

        layout, found = self.layout.dup(), {}
        top, reach = layout.top_cell(), max(layer.space for layer in self.wiring.layers)
        below = [inst.cell_inst for inst in top.each_inst()]
        outlines = [inst.bbox() for inst in top.each_inst()]
        places = np.array(
            [(box.left, box.bottom, box.right, box.top, number) for number, box in enumerate(outlines)], int
        ).reshape(-1, BOX_AND_NET)
        kept = set()
        for name, box in (made for net in nets for made in self.boxes[net]):
            around = box[0] - reach, box[1] - reach, box[2] + reach, box[3] + reach
            kept.update(near(places, around)[:, 4].tolist())
            if name in self.levels:
                for row in near(self.there[self.levels[name]], around).tolist():
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

    def beside(self, nets):
        """Names of all nets with a wire that meets one of ``nets``, these too."""
        return {
            self.nets[number]
            for net in nets
            for name, box in self.boxes[net]
            if name in self.levels
            for number in self.owners(self.there, self.levels[name], box)
        }

    def owners(self, there, level, box):
        """Numbers of the nets with a wire that meets ``box``; there: this board's, of now or of before."""
        return near(there[level], box)[:, 4].tolist()

    def at(self, there, level, polygon):
        """Names of the nets with a box whose middle lies in the ``polygon``, as KLayout writes one; there: as above."""
        import klayout.db as db

        polygon = db.Polygon.from_s(polygon)
        box = polygon.bbox()
        return {
            self.nets[number]
            for *ends, number in near(there[level], (box.left, box.bottom, box.right, box.top))
            if polygon.inside(db.Point(*map(int, middle(ends))))
        }


def near(there, reach):
    """Rows of the array ``there``, (left, bottom, right, top, ...), that meet the box ``reach``."""
    return there[_meets(there, *map(int, reach))]


@njit(cache=True)
def _meets(there, left, bottom, right, top):
    """Numbers of these rows."""
    found = np.empty(len(there), np.int64)
    count = 0
    for k in range(len(there)):
        if there[k, 0] <= right and there[k, 2] >= left and there[k, 1] <= top and there[k, 3] >= bottom:
            found[count] = k
            count += 1
    return found[:count]


def _claims(shapes):
    """dict (layer, box) -> net of the wires, dict (layer, middle) -> net of the pads and cuts (in the middles of cuts
    and at wires' ends), set of (layer, box) of the pins."""
    exact, middles, ports = {}, {}, set()
    for net, made in shapes.items():
        for name, *box in made["wires"]:
            box = nanometres(box)
            for key in ((name, box), (name, middle(box))):
                (exact if key[1] is box else middles).setdefault(key, net)
            for end in _ends(box):
                middles.setdefault((name, end), net)
        for name, x, y in made["cuts"]:
            for part in name.split("_"):
                middles.setdefault((part, nanometres((x, y))), net)
        ports |= {(name, nanometres(box)) for pin in made["pins"] for name, *box in pin}
    return exact, middles, ports


def middle(box):
    return (box[0] + box[2]) // 2, (box[1] + box[3]) // 2


def _ends(box):
    """Middles of the two ends of a wire."""
    (left, bottom, right, top), (x, y) = box, middle(box)
    return ((left, y), (right, y)) if right - left > top - bottom else ((x, bottom), (x, top))


def nanometres(values):
    return tuple(round(1000 * value) for value in values)
