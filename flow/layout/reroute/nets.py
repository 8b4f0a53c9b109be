"""A net from pin to pin: its ways through a window, and the shapes that they are."""

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from .search import search
from .window import Site, Window

MARGINS_NM = (10_000, 40_000, 120_000)  # of the window around two places to be joined: of a try, of the next
DETOUR_NM = 240_000  # the same where there was no way at all: round a block
AROUND_PIN_NM = 12_000  # of that around a pin
HIGHEST = 8  # price of the highest wire where it is to be short
HOP_NM, REACH = 1500, 40  # length of a piece of it; its distance from a pin, in steps of the grid
CELL_PINS = 0  # level of the layer of the cells' pins, on which nothing is routed


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


def routed(board, pins, hops=False):
    """(Shapes, names of the nets in their way, [(level, box), ...] of where) of a net that is not on the ``board``.

    pins: lists of (level, left, bottom, right, top), of which any is to be met. hops: whether every cell that has room
    for it is joined over a piece of the highest wire, against antennas: until that is there, what is joined to a gate
    is short. None when there is no way past what is fixed, or no room for what a rule asks.
    """
    own = {}
    for level, *box in (box for pin in pins for box in pin if box[0] != CELL_PINS):
        own.setdefault(level, []).append(box)
    found, site = [], Site(board, own)
    accesses = [_met(site, pin, hops) for pin in pins]
    for margin in (*MARGINS_NM, DETOUR_NM) if all(accesses) else ():
        if found and margin == DETOUR_NM:
            break
        shapes = _connected(site, accesses, margin, hops)
        if shapes and enlarged(site, shapes):
            found.append((shapes, *site.fought_over(shapes)))
            if not found[-1][1]:
                break
    return min(found, key=lambda one: len(one[1]), default=None)


def _connected(site, accesses, margin, hops):
    """Shapes that join the pins that are met by ``accesses``, always the one next to what is joined; None without a way."""
    dear = {len(site.wiring.layers) - 1: HIGHEST} if hops else None
    shapes, tree = Shapes(), {}
    waiting = [list(access) for access in accesses]
    joined = np.array(waiting[0])
    left = list(range(1, len(accesses)))
    nearest = {k: _nearest(site, waiting[k], joined) for k in left}
    while left:
        k = min(left, key=lambda k: nearest[k][0])
        left.remove(k)
        window = Window(site, _box(nearest[k][1], margin))
        way = search(window, tree or accesses[0], accesses[k], dear)
        if way is None:
            return None
        if not tree:
            _join(shapes, accesses[0][way[0]])
        _join(shapes, accesses[k][way[-1]])
        _draw(shapes, window, way)
        tree |= dict.fromkeys(way)
        for other in left:
            nearest[other] = min(
                nearest[other], _nearest(site, waiting[other], np.array(way)), key=lambda found: found[0]
            )
    return shapes


def _nearest(site, places, joined):
    """(distance, ((x, y), (x, y)), nm) between the first of ``places`` and the nearest of the array ``joined``."""
    step = np.array(site.wiring.step)
    here, there = np.array(places[0])[1:] * step, joined[:, 1:] * step
    distances = np.abs(there - here).sum(1)
    return int(distances.min()), (tuple(map(int, here)), tuple(map(int, there[distances.argmin()])))


def _box(points, margin):
    (a, b), (c, d) = points
    return min(a, c) - margin, min(b, d) - margin, max(a, c) + margin, max(b, d) + margin


def _met(site, pin, hops):
    """dict place -> Shapes that lead from there into the ``pin``, over a hop if it is asked for and there is room."""
    around = [f(box[k] for box in pin) for f, k in ((min, 1), (min, 2), (max, 3), (max, 4))]
    window = Window(site, _box((around[:2], around[2:]), AROUND_PIN_NM))
    accesses = _accesses(window, pin)
    return hops and pin[0][0] == CELL_PINS and _hop(window, accesses) or accesses


def _hop(window, accesses):
    """The same pin met on the highest wire alone, HOP_NM from the cut that leads down: dict place -> Shapes; {} where
    there is no room. What lies below is an obstacle from then on."""
    highest = len(window.wiring.layers) - 1
    free, cuts = window.wires[highest] == 0, window.cuts[highest - 1] == 0
    right, up = (-(-HOP_NM // window.dx), 0) if window.wiring.layers[highest].across else (0, -(-HOP_NM // window.dy))
    places = {}
    for _, i, j in list(accesses)[:1]:
        i, j = i - window.first[0], j - window.first[1]
        for column in range(max(right, i - REACH), min(window.shape[0] - right, i + REACH)):
            for row in range(max(up, j - REACH), min(window.shape[1] - up, j + REACH)):
                if cuts[column, row]:
                    for x, y in ((column + right, row + up), (column - right, row - up)):
                        if (
                            cuts[x, y]
                            and free[min(x, column) : max(x, column) + 1, min(y, row) : max(y, row) + 1].all()
                        ):
                            here, end = (
                                (highest, a + window.first[0], b + window.first[1]) for a, b in ((column, row), (x, y))
                            )
                            places[here] = end
    way = search(window, accesses, places) if places else None
    if way is None:
        return {}
    shapes, end = Shapes(), places[way[-1]]
    _join(shapes, accesses[way[0]])
    _draw(shapes, window, way)
    if not enlarged(window.site, shapes, alone=True):
        return {}
    below = {level: list(boxes) for level, boxes in shapes.wires.items() if level != highest}
    _draw(shapes, window, [way[-1], end])
    for level, boxes in below.items():
        for box in boxes:
            window.site.block(level, box)
    return {end: shapes}


def _accesses(window, pin):
    """dict place -> Shapes from there into the pin, for every place from which it can be met with the least strife."""
    found = {}
    for level, left, bottom, right, top in pin:
        middle = (left + right) // 2
        if level != CELL_PINS:
            points = [(middle, (bottom + top) // 2)]
        else:
            _, high = window.wiring.cuts[CELL_PINS].below
            first, last = -(-(bottom + high) // window.dy), (top - high) // window.dy
            points = [(middle, j * window.dy) for j in range(first, last + 1)]
        for x, y in points:
            for i, j in window.near(x, y):
                place = max(level, CELL_PINS + 1), i, j
                access = window.inside(place) and _access(window, level, (x, y), window.at(i, j))
                if access:
                    strife = sum(window.strife(at, box) for at, boxes in access.wires.items() for box in boxes)
                    found.setdefault(strife, {})[place] = access
    return found[min(found)] if found else {}


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
    for level, length in more.lengths.items():
        shapes.lengths[level] = shapes.lengths.get(level, 0) + length


def _draw(shapes, window, way):
    """Add the wires and cuts of ``way``, places of which one follows another along a row, a column or through a cut."""
    for (level, *here), (other, *there) in pairwise(_corners(way)):
        if other != level:
            shapes.cut(window.wiring, min(level, other), *window.at(*here))
        else:
            (left, right), (bottom, top) = map(sorted, zip(window.at(*here), window.at(*there), strict=True))
            half = (window.wiring.layers[level].width // 2,) * 2
            shapes.wire(level, _around(left, bottom, right, top, half), right - left + top - bottom)


def _corners(way):
    """Its places where it begins, turns, has a cut or ends."""
    turns = [
        here
        for before, here, after in zip(way, way[1:], way[2:], strict=False)
        if before[0] != after[0] or any(y - x != z - y for x, y, z in zip(before, here, after, strict=True))
    ]
    return [way[0], *turns, *way[1:][-1:]]


def enlarged(site, shapes, alone=False):
    """Whether every piece of wire has, or could be given, the least area; gaps within the net are closed. alone: no
    other net is to make room for that."""
    import klayout.db as db

    for level, boxes in shapes.wires.items():
        layer = site.wiring.layers[level]
        region = db.Region([db.Box(*box) for box in boxes]).merged()
        gap = layer.space // 2
        for polygon in (region.sized(gap).sized(-gap) - region).decompose_trapezoids_to_region().each():
            box = polygon.bbox()
            boxes.append((box.left, box.bottom, box.right, box.top))
        for pair in db.Region([db.Box(*box) for box in boxes]).merged().width_check(layer.width).each():
            wider = _at_least(pair.bbox(), layer.width)  # where two pieces overlap by less than a wire's width
            if not site.clear(level, wider):
                return False
            boxes.append(wider)
        for polygon in db.Region([db.Box(*box) for box in boxes]).merged().each():
            lack = layer.area - polygon.area()
            if lack > 0:
                more = _longer(site, level, polygon.bbox(), lack, alone)
                if more is None:
                    return False
                boxes.append(more)
    return True


def _at_least(box, width):
    """(left, bottom, right, top) of ``box`` with sides of at least ``width``, on a grid of 5 nm."""
    x, y = (max(0, -(-(width - side) // 10) * 5) for side in (box.width(), box.height()))
    return box.left - x, box.bottom - y, box.right + x, box.top + y


def _longer(site, level, box, lack, alone):
    """A box that makes the piece of wire ``box`` larger by ``lack`` nm2 and is clear, of all if it can be or, with
    ``alone``, must; else None."""
    wide = -(-lack // box.height()) // 10 * 10 + 10
    high = -(-lack // box.width()) // 10 * 10 + 10
    tries = [
        (wide, 0, 0, 0),
        (0, 0, wide, 0),
        (wide // 2, 0, wide // 2, 0),
        (0, high, 0, 0),
        (0, 0, 0, high),
        (0, high // 2, 0, high // 2),
    ]
    made = [
        (box.left - left, box.bottom - bottom, box.right + right, box.top + top) for left, bottom, right, top in tries
    ]
    return next(
        (one for others in ([True] if alone else [True, False]) for one in made if site.clear(level, one, others)), None
    )
