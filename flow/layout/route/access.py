"""How a pin is met: the routes into it, from places of the grid."""

from collections.abc import Sequence

from ..geometry.boxes import Box
from .board import CUTS, Board
from .route import CELL_PINS, Place, Point, Route, around
from .view import NetView

Pin = Sequence[Sequence[int]]  # (level, left, bottom, right, top), of which any is to be met
Access = tuple[Place, int, Point]  # a place, the level and a point of the pin
Accesses = dict[Place, Route]  # by place the route from there into a pin


def accesses(view: NetView, net: str, number: int) -> Accesses:
    """Routes into the pin ``number`` of ``net`` from every place from which it can be met; their costs in ``view``."""
    found: Accesses = {}
    for place, level, point in _possible(view, net, number):
        route = _access(view.board, level, point, place)
        cost = sum(view.congestion(at, box) for at, boxes in route.segments.items() for box in boxes)
        if place not in found or cost < view.costs[place]:
            found[place], view.costs[place] = route, cost
    return found


def _possible(view: NetView, net: str, number: int) -> list[Access]:
    """What nothing fixed is in the way of, found once."""
    known = view.board.accesses.setdefault(net, {})
    if number not in known:
        known[number] = [made for made in _all(view.board, view.board.pins[net][number]) if _clear(view, *made)]
    return known[number]


def _all(board: Board, pin: Pin) -> list[Access]:
    """All ways into a ``pin``."""
    made = []
    for level, left, bottom, right, top in pin:
        middle = (left + right) // 2
        points = [(middle, (bottom + top) // 2)]
        if level == CELL_PINS:
            _, high = board.rules.vias[CELL_PINS].below
            pitch = board.rules.step[1]
            points = [(middle, k * pitch) for k in range(-(-(bottom + high) // pitch), (top - high) // pitch + 1)]
        for point in points:
            for i, j in board.grid.near(*point):
                if board.grid.inside((level, i, j)):
                    made.append(((max(level, CELL_PINS + 1), i, j), level, point))
    return made


def _clear(view: NetView, place: Place, level: int, point: Point) -> bool:
    """Whether nothing fixed is in the way."""
    if level == CELL_PINS:
        via = view.rules.vias[level]
        reach = via.size // 2 + via.space - 1
        if len(view.board.fixed.touching(CUTS, around(point, point, (reach, reach)))):
            return False
    made: dict[int, list[Box]] = _access(view.board, level, point, place).segments
    return all(view.clear(at, box) for at, boxes in made.items() for box in boxes)


def _access(board: Board, level: int, point: Point, place: Place) -> Route:
    """Route from ``place`` to the ``point`` of a pin on ``level``."""
    route = Route()
    if level == CELL_PINS:
        route.via(board.rules, level, point)
    there = board.grid.at(*place[1:])
    low, high = ((f(point[0], there[0]), f(point[1], there[1])) for f in (min, max))
    route.segment(place[0], around(low, high, board.rules.layers[place[0]].half))
    return route
