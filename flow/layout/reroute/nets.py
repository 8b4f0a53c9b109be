"""A net from pin to pin: its paths through windows, and the route along them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..geometry.boxes import Box, Boxes
from .area import meet_area
from .board import Board, overlapping
from .route import CELL_PINS, Place, Point, Route, around
from .search import search
from .window import NetView, Window

MARGINS_NM = (10_000, 40_000, 120_000)  # of the window around two places to be joined: of a try, of the next
DETOUR_NM = 240_000  # the same where there was no path at all: round a block
AROUND_PIN_NM = 12_000  # of that around a pin
TOP_FACTOR = 8  # of the cost of the top layer where it is to be short
JUMPER_NM, REACH = 1500, 40  # length of an antenna jumper; its distance from a pin, in steps of the grid

Pin = Sequence[Sequence[int]]  # (level, left, bottom, right, top), of which any is to be met
Accesses = dict[Place, Route]  # by place the route from there into a pin


@dataclass(frozen=True)
class Found:
    """A route of a net, names of the nets in its way, and (level, Box) of where."""

    route: Route
    evicted: set[str]
    places: list[tuple[int, Box]]


def route_net(board: Board, pins: Sequence[Pin], jumpers: bool = False) -> Found | None:
    """Route a net that is not on the ``board``, with the fewest nets in its way.

    jumpers: whether every cell that has room for it is joined over a jumper on the top layer, against antennas: until
    that layer is made, what is joined to a gate is short. None when there is no path past what is fixed, or no room for
    what a rule requires.
    """
    own: dict[int, list[Sequence[int]]] = {}
    for level, *box in (box for pin in pins for box in pin if box[0] != CELL_PINS):
        own.setdefault(level, []).append(box)
    view, found = NetView(board, own), []
    accesses = [_pin_accesses(view, pin, jumpers) for pin in pins]
    for margin in (*MARGINS_NM, DETOUR_NM) if all(accesses) else ():
        if found and margin == DETOUR_NM:
            break
        route = _connected(view, accesses, margin, jumpers)
        if route and meet_area(view, route):
            found.append(Found(route, *view.conflicts(route)))
            if not found[-1].evicted:
                break
    return min(found, key=lambda one: len(one.evicted), default=None)


def _connected(view: NetView, accesses: Sequence[Accesses], margin: int, jumpers: bool) -> Route | None:
    """Join the pins that are met by ``accesses``, always the one nearest to what is joined; None without a path."""
    factors = {len(view.rules.layers) - 1: TOP_FACTOR} if jumpers else None
    route, tree = Route(), {}
    waiting = [list(access) for access in accesses]
    joined = np.array(waiting[0])
    left = list(range(1, len(accesses)))
    nearest = {k: _nearest(view, waiting[k], joined) for k in left}
    while left:
        k = min(left, key=lambda k: nearest[k][0])
        left.remove(k)
        window = Window(view, _box(*nearest[k][1:], margin))
        path = search(window, tree or accesses[0], accesses[k], factors)
        if path is None:
            return None
        if not tree:
            route.join(accesses[0][path[0]])
        route.join(accesses[k][path[-1]])
        route.draw(view.rules, path)
        tree |= dict.fromkeys(path)
        for other in left:
            closer = _nearest(view, waiting[other], np.array(path))
            nearest[other] = closer if closer[0] < nearest[other][0] else nearest[other]
    return route


def _nearest(view: NetView, places: Sequence[Place], joined: Boxes) -> tuple[int, Point, Point]:
    """(distance, points, nm) of the first of ``places`` and the nearest of the array ``joined`` of places."""
    (dx, dy), (_, i, j) = view.rules.step, places[0]
    points = joined[:, 1:] * (dx, dy)
    distances = np.abs(points - (i * dx, j * dy)).sum(1)
    x, y = points[distances.argmin()].tolist()
    return int(distances.min()), (i * dx, j * dy), (x, y)


def _box(one: Point, other: Point, margin: int) -> Box:
    (a, b), (c, d) = one, other
    return min(a, c) - margin, min(b, d) - margin, max(a, c) + margin, max(b, d) + margin


def _pin_accesses(view: NetView, pin: Pin, jumpers: bool) -> Accesses:
    """Routes into the ``pin``, over an antenna jumper if that is wanted and there is room."""
    left, bottom, right, top = (f(box[k] for box in pin) for f, k in ((min, 1), (min, 2), (max, 3), (max, 4)))
    window = Window(view, _box((left, bottom), (right, top), AROUND_PIN_NM))
    accesses = _accesses(window, pin)
    return jumpers and pin[0][0] == CELL_PINS and _jumper(window, accesses) or accesses


def _jumper(window: Window, accesses: Accesses) -> Accesses:
    """The same pin met on the top layer alone, JUMPER_NM from the via that leads down; {} where there is no room.

    What is below the jumper is an obstacle from then on.
    """
    top = len(window.rules.layers) - 1
    free, vias = window.metals[top] == 0, window.vias[top - 1] == 0
    right, up = -(-JUMPER_NM // window.dx), -(-JUMPER_NM // window.dy)
    right, up = (right, 0) if window.rules.layers[top].horizontal else (0, up)
    places, (west, south) = {}, window.first
    for _, i, j in list(accesses)[:1]:
        i, j = i - west, j - south
        for column in range(max(right, i - REACH), min(window.shape[0] - right, i + REACH)):
            for row in range(max(up, j - REACH), min(window.shape[1] - up, j + REACH)):
                for x, y in ((column + right, row + up), (column - right, row - up)) if vias[column, row] else ():
                    if vias[x, y] and free[min(x, column) : max(x, column) + 1, min(y, row) : max(y, row) + 1].all():
                        places[top, column + west, row + south] = top, x + west, y + south
    path = search(window, accesses, places) if places else None
    if path is None:
        return {}
    route, end = Route(), places[path[-1]]
    route.join(accesses[path[0]])
    route.draw(window.rules, path)
    if not meet_area(window.view, route, alone=True):
        return {}
    below = {level: list(boxes) for level, boxes in route.segments.items() if level != top}
    route.draw(window.rules, [path[-1], end])
    for level, boxes in below.items():
        for box in boxes:
            window.view.block(level, box)
    return {end: route}


def _accesses(window: Window, pin: Pin) -> Accesses:
    """Routes into the pin from every place from which it can be met with the least congestion."""
    found: dict[int, Accesses] = {}
    for level, left, bottom, right, top in pin:
        middle = (left + right) // 2
        if level != CELL_PINS:
            points = [(middle, (bottom + top) // 2)]
        else:
            _, high = window.rules.vias[CELL_PINS].below
            first, last = -(-(bottom + high) // window.dy), (top - high) // window.dy
            points = [(middle, j * window.dy) for j in range(first, last + 1)]
        for point in points:
            for i, j in window.near(*point):
                place = max(level, CELL_PINS + 1), i, j
                access = _access(window, level, point, window.at(i, j)) if window.inside(place) else None
                if access:
                    boxes = [(at, box) for at, boxes in access.segments.items() for box in boxes]
                    congestion = sum(window.congestion(at, box) for at, box in boxes)
                    found.setdefault(congestion, {})[place] = access
    return found[min(found)] if found else {}


def _access(window: Window, level: int, point: Point, place: Point) -> Route | None:
    """Route from ``place`` to the ``point`` of a pin on ``level``, None where something fixed is in the way."""
    route, above = Route(), max(level, CELL_PINS + 1)
    if level == CELL_PINS:
        route.via(window.rules, level, point)
        via = window.rules.vias[level]
        reach = via.size // 2 + via.space - 1
        if len(overlapping(window.view.board.cuts, around(point, point, (reach, reach)))):
            return None
    low, high = ((f(point[0], place[0]), f(point[1], place[1])) for f in (min, max))
    route.segment(above, around(low, high, window.rules.layers[above].half))
    return route if all(window.clear(above, box) for box in route.segments[above]) else None
