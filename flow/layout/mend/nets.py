"""A net from pin to pin: its ways through a window, and the shapes that they are."""

from dataclasses import dataclass, field
from itertools import pairwise

from .search import search
from .window import Window

MARGINS_NM = (20_000, 60_000, 200_000)      # of the window around the pins: of the first try, of the next
HIGHEST = 8                                 # price of the highest wire where it is to be short
HOP_NM, REACH = 1500, 40                    # length of a piece of it; its distance from a pin, in steps of the grid
CELL_PINS = 0                               # level of the layer of the cells' pins, on which nothing is routed


@dataclass
class Shapes:
    """wires: dict level -> boxes (nm). cuts: dict level -> middles (x, y) of cuts to the layer above. lengths: dict
    level -> nm of wire."""

    wires: dict = field(default_factory=dict)
    cuts: dict = field(default_factory=dict)
    lengths: dict = field(default_factory=dict)

    def wire(self, level, box, length=0):
        self.wires.setdefault(level, []).append(box)
        self.lengths[level] = self.lengths.get(level, 0) + length

    def cut(self, wiring, level, x, y):
        self.cuts.setdefault(level, []).append((x, y))
        for at, half in ((level, wiring.cuts[level].below), (level + 1, wiring.cuts[level].above)):
            if at != CELL_PINS:
                self.wire(at, _around(x, y, x, y, half))


def routed(layout, top, wiring, pins, hops=False):
    """Shapes of a net whose pins are ``pins``: lists of (level, left, bottom, right, top), of which any is to be met.

    hops: whether every cell that has room for it is joined over a piece of the highest wire, against antennas: until
    that is there, what is joined to a gate is short. None when there is no way, or no room for what a rule asks.
    """
    own = {}
    for box in (box for pin in pins for box in pin if box[0] != CELL_PINS):
        own.setdefault(box[0], []).append(box[1:])
    around = [f(box[k] for pin in pins for box in pin) for f, k in ((min, 1), (min, 2), (max, 3), (max, 4))]
    die = top.bbox()
    for margin in MARGINS_NM:
        box = (max(around[0] - margin, die.left), max(around[1] - margin, die.bottom),
               min(around[2] + margin, die.right), min(around[3] + margin, die.top))
        window = Window(layout, top, wiring, box, own)
        accesses = [_accesses(window, pin) for pin in pins]
        if hops:
            accesses = [_hop(window, access) or access if pin[0][0] == CELL_PINS else access
                        for pin, access in zip(pins, accesses, strict=True)]
        prices = {len(wiring.layers) - 1: HIGHEST} if hops else None
        shapes = _connected(window, accesses, prices) if all(accesses) else None
        if shapes and enlarged(window, shapes):
            return shapes
    return None


def _connected(window, pins, prices):
    """Shapes that join ``pins``: dicts place -> Shapes that lead from there into the pin; None without a way."""
    shapes, tree = Shapes(), set()
    first, *left = pins
    while left:
        targets = {place: (k, access) for k, pin in enumerate(left) for place, access in pin.items()}
        way = search(window, tree or set(first), set(targets), prices)
        if way is None:
            return None
        if not tree:
            _join(shapes, first[way[0]])
        k, access = targets[way[-1]]
        _join(shapes, access)
        _draw(shapes, window, way)
        tree |= set(way)
        del left[k]
    return shapes


def _hop(window, accesses):
    """The same pin met on the highest wire alone, HOP_NM from the cut that leads down: dict place -> Shapes; {} where
    there is no room. What lies below is an obstacle from then on."""
    highest = len(window.wiring.layers) - 1
    free, cuts = window.wires[highest], window.cuts[highest - 1]
    right, up = (-(-HOP_NM // window.dx), 0) if window.wiring.layers[highest].across else (0, -(-HOP_NM // window.dy))
    places = {}
    for _, i, j in list(accesses)[:1]:
        for column in range(max(right, i - REACH), min(window.columns - right, i + REACH)):
            for row in range(max(up, j - REACH), min(window.rows - up, j + REACH)):
                if cuts[column, row]:
                    for x, y in ((column + right, row + up), (column - right, row - up)):
                        if cuts[x, y] and free[min(x, column):max(x, column) + 1, min(y, row):max(y, row) + 1].all():
                            places[highest, column, row] = highest, x, y
    way = search(window, set(accesses), set(places)) if places else None
    if way is None:
        return {}
    shapes, end = Shapes(), places[way[-1]]
    _join(shapes, accesses[way[0]])
    _draw(shapes, window, way)
    below = {level: list(boxes) for level, boxes in shapes.wires.items() if level != highest}
    _draw(shapes, window, [way[-1], end])
    for level, boxes in below.items():
        for box in boxes:
            window.block(level, box)
    return {end: shapes}


def _accesses(window, pin):
    """dict place -> Shapes from there into the pin, for every place from which it can be met."""
    found = {}
    for level, left, bottom, right, top in pin:
        middle = (left + right) // 2
        if level != CELL_PINS:
            points = [(middle, (bottom + top) // 2)]
        else:
            _, high = window.wiring.cuts[CELL_PINS].below
            first, last = (-(-(bottom + high - window.bottom) // window.dy), (top - high - window.bottom) // window.dy)
            points = [(middle, window.bottom + j * window.dy) for j in range(first, last + 1)]
        for x, y in points:
            for i, j in window.near(x, y):
                access = _access(window, level, (x, y), window.at(i, j))
                if access:
                    found[max(level, CELL_PINS + 1), i, j] = access
    return found


def _access(window, level, point, place):
    """Shapes from ``place`` to the ``point`` of a pin on ``level``, None where others are in the way."""
    shapes, above = Shapes(), max(level, CELL_PINS + 1)
    if level == CELL_PINS:
        shapes.cut(window.wiring, level, *point)
    half = (window.wiring.layers[above].width // 2,) * 2
    shapes.wire(above, _around(*(f(a, b) for f in (min, max) for a, b in zip(point, place, strict=True)), half))
    return shapes if all(window.clear(above, box) for box in shapes.wires[above]) else None


def _around(left, bottom, right, top, half):
    return left - half[0], bottom - half[1], right + half[0], top + half[1]


def _join(shapes, more):
    for name in ("wires", "cuts"):
        for level, made in getattr(more, name).items():
            getattr(shapes, name).setdefault(level, []).extend(made)


def _draw(shapes, window, way):
    """Add the wires and cuts of ``way``, places of which one follows another along a row, a column or through a cut."""
    for (level, *here), (other, *there) in pairwise(way):
        if other != level:
            shapes.cut(window.wiring, min(level, other), *window.at(*here))
        else:
            (left, right), (bottom, top) = map(sorted, zip(window.at(*here), window.at(*there), strict=True))
            half = (window.wiring.layers[level].width // 2,) * 2
            shapes.wire(level, _around(left, bottom, right, top, half), right - left + top - bottom)


def enlarged(window, shapes):
    """Whether every piece of wire has, or could be given, the least area; gaps within the net are closed."""
    import klayout.db as db
    for level, boxes in shapes.wires.items():
        layer = window.wiring.layers[level]
        region = db.Region([db.Box(*box) for box in boxes]).merged()
        gap = layer.space // 2
        for polygon in (region.sized(gap).sized(-gap) - region).decompose_trapezoids_to_region().each():
            box = polygon.bbox()
            boxes.append((box.left, box.bottom, box.right, box.top))
        for polygon in db.Region([db.Box(*box) for box in boxes]).merged().each():
            lack = layer.area - polygon.area()
            if lack > 0:
                more = _longer(window, level, polygon.bbox(), lack)
                if more is None:
                    return False
                boxes.append(more)
    return True


def _longer(window, level, box, lack):
    """A box that makes the piece of wire ``box`` larger by ``lack`` nm2 and is clear, or None."""
    wide = -(-lack // box.height()) // 10 * 10 + 10
    high = -(-lack // box.width()) // 10 * 10 + 10
    tries = [(wide, 0, 0, 0), (0, 0, wide, 0), (wide // 2, 0, wide // 2, 0),
             (0, high, 0, 0), (0, 0, 0, high), (0, high // 2, 0, high // 2)]
    for left, bottom, right, top in tries:
        made = (box.left - left, box.bottom - bottom, box.right + right, box.top + top)
        if window.clear(level, made):
            return made
    return None
