"""A net from pin to pin: its paths, and the route along them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..geometry.boxes import Box, Boxes
from .access import Accesses, accesses
from .area import meet_area
from .board import Board
from .route import CELL_PINS, Place, Point, Route
from .view import NetView

MARGINS_NM = (10_000, 40_000)  # of the window around two places to be joined: of a try, of the next
DETOUR_NM = 240_000  # the same where there was no path at all: round a block
AROUND_PIN_NM = 20_000  # of that around a pin
TOP_FACTOR = 8  # of the cost of the top layer where it is to be short
JUMPER_NM, REACHES = 1500, (40, 80)  # length of an antenna jumper; its distance from a pin, in steps: or farther
JUMPER_PLACES, APART = 6, 5  # that are tried where there is no room below a jumper, and the steps between them


@dataclass(frozen=True)
class Found:
    """A route of a net, names of the nets in its way, and (level, Box) of where."""

    route: Route
    evicted: set[str]
    places: list[tuple[int, Box]]


def route_net(board: Board, net: str, jumpers: bool = False, hasty: bool = False) -> Found | None:
    """Route ``net``, which has no shapes on the ``board``, with the fewest nets in its way.

    hasty: whether the first path that there is will do.

    jumpers: whether every cell that has room for it is joined over a jumper on the top layer, against antennas: until
    that layer is made, what is joined to a gate is short. None when there is no path past what is fixed, or no room for
    what a rule requires.
    """
    view = NetView(board, board.numbers[net])
    try:
        made = [_pin_accesses(view, net, number, jumpers) for number in range(len(board.pins[net]))]
        found = []
        for margin in (*MARGINS_NM, DETOUR_NM) if all(made) else ():
            if found and margin == DETOUR_NM:
                break
            route = _connected(view, made, margin, jumpers)
            if route and meet_area(view, route):
                found.append(Found(route, *view.conflicts(route)))
                if hasty or not found[-1].evicted:
                    break
        return min(found, key=lambda one: len(one.evicted), default=None)
    finally:
        view.release()


def _connected(view: NetView, pins: Sequence[Accesses], margin: int, jumpers: bool) -> Route | None:
    """Join the ``pins``, always the one nearest to what is joined; None without a path."""
    factors = {len(view.rules.layers) - 1: TOP_FACTOR} if jumpers else None
    route, tree = Route(), {}
    waiting = [list(access) for access in pins]
    joined = np.array(waiting[0])
    left = list(range(1, len(pins)))
    nearest = {k: _nearest(view, waiting[k], joined) for k in left}
    while left:
        k = min(left, key=lambda k: nearest[k][0])
        left.remove(k)
        path = _path(view, _box(*nearest[k][1:], margin), tree or pins[0], pins[k], factors)
        if path is None:
            return None
        if not tree:
            route.join(pins[0][path[0]])
        route.join(pins[k][path[-1]])
        route.draw(view.rules, path)
        tree |= dict.fromkeys(path)
        for other in left:
            closer = _nearest(view, waiting[other], np.array(path))
            nearest[other] = closer if closer[0] < nearest[other][0] else nearest[other]
    return route


def _path(
    view: NetView, box: Box, sources: Mapping[Place, object], targets: Accesses, factors: Mapping[int, int] | None
) -> list[Place] | None:
    return view.board.grid.search(view.net, box, list(sources), list(targets), factors, view.costs)


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


def _pin_accesses(view: NetView, net: str, number: int, jumpers: bool) -> Accesses:
    """Routes into a pin, over an antenna jumper if that is wanted and there is room."""
    found = accesses(view, net, number)
    if not jumpers or view.board.pins[net][number][0][0] != CELL_PINS:
        return found
    return _jumper(view, found) or found


def _jumper(view: NetView, pin: Accesses) -> Accesses:
    """The same pin met on the top layer alone, JUMPER_NM from the via that leads down; {} where there is no room.

    What is below the jumper is an obstacle from then on.
    """
    grid, top = view.board.grid, len(view.rules.layers) - 1
    dx, dy = view.rules.step
    right, up = (-(-JUMPER_NM // dx), 0) if view.rules.layers[top].horizontal else (0, -(-JUMPER_NM // dy))
    places: dict[Place, Place] = {}
    _, i, j = next(iter(pin))
    for reach in REACHES:
        if places:
            break
        x, y = i - reach - right, j - reach - up
        box = max(x, grid.first[0]), max(y, grid.first[1]), i + reach + right, j + reach + up
        west, south = int(box[0]), int(box[1])
        present = view.board.present
        free, vias = grid.free(view.net, top, box, present), grid.free(view.net, top - 1, box, present, vias=True)
        for column, row in np.argwhere(vias).tolist():
            for a, b in (column + right, row + up), (column - right, row - up):
                if not (0 <= a < vias.shape[0] and 0 <= b < vias.shape[1] and vias[a, b]):
                    continue
                if free[min(a, column) : max(a, column) + 1, min(b, row) : max(b, row) + 1].all():
                    places[top, column + west, row + south] = top, a + west, b + south
    at = [grid.at(i, j) for _, i, j in pin]
    ends = min(x for x, _ in at), min(y for _, y in at), max(x for x, _ in at), max(y for _, y in at)
    for _ in range(JUMPER_PLACES):
        path = _path(view, _box(ends[:2], ends[2:], AROUND_PIN_NM), pin, dict.fromkeys(places, Route()), None)
        if path is None:
            break
        route, end = Route(), places[path[-1]]
        route.join(pin[path[0]])
        route.draw(view.rules, path)
        if meet_area(view, route, alone=True):
            below = [(level, box) for level, boxes in route.segments.items() if level != top for box in boxes]
            route.draw(view.rules, [path[-1], end])
            view.hold(below)
            return {end: route}
        _, i, j = path[-1]
        places = {at: end for at, end in places.items() if abs(at[1] - i) + abs(at[2] - j) > APART}
    return {}
