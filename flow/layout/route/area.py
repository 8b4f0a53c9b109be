"""The least area and width of a route's pieces of metal."""

from typing import Any

from talbot.base.gds import db

from ..geometry.boxes import Box, corners, on_grid
from .route import Route
from .view import NetView

ROUNDS = 4  # in which narrow places and gaps of a net are filled


def meet_area(view: NetView, route: Route) -> list[tuple[int, Box]]:
    """Give every piece of metal the least area and close gaps within the net.

    Return (level, box) of what there is no room for; none if all is done.
    """
    pins = [box for pin in view.board.pins[view.board.nets[view.net]] for box in pin]
    for level, boxes in route.segments.items():
        layer = view.rules.layers[level]
        boxes += [(left, bottom, right, top) for at, left, bottom, right, top in pins if at == level]
        for polygon in _merged(boxes).each():
            lack = layer.area - polygon.area()
            if lack > 0:
                made = _longer(view, level, polygon.bbox(), lack)
                if made is None:
                    return [(level, corners(polygon.bbox()))]
                boxes.append(made)
        region = _merged(boxes)
        gap = layer.space // 2
        for polygon in (region.sized(gap).sized(-gap) - region).decompose_trapezoids_to_region().each():
            boxes.append(on_grid(polygon.bbox()))
        for _ in range(ROUNDS):  # pieces corner to corner, or that overlap by less than the least width
            merged = _merged(boxes)
            pairs = (*merged.space_check(layer.space).each(), *merged.width_check(layer.width).each())
            more = [_at_least(pair.bbox(), layer.width) for pair in pairs]
            if blocked := [(level, box) for box in more if not view.clear(level, box)]:
                return blocked
            boxes += more
            if not more:
                break
    return []


def _merged(boxes: list[Box]) -> "db.Region":
    shapes: Any = [db.Box(*box) for box in boxes]  # KLayout's stub lacks this overload
    return db.Region(shapes).merged()


def _corners(box: "db.Box", left: int = 0, bottom: int = 0, right: int = 0, top: int = 0) -> Box:
    """``box`` made larger by so much on its sides."""
    return box.left - left, box.bottom - bottom, box.right + right, box.top + top


def _at_least(box: "db.Box", width: int) -> Box:
    """``box`` with sides of at least ``width``, on a grid of 5 nm."""
    x, y = (max(0, -(-(width - side) // 10) * 5) for side in (box.width(), box.height()))
    return on_grid(box.enlarged(x, y))


def _longer(view: NetView, level: int, box: "db.Box", lack: int) -> Box | None:
    """A box that makes the piece of metal ``box`` larger by ``lack`` nm2, clear of all nets if it can be, else of what
    is fixed. None without one."""
    wide = -(-lack // box.height()) // 10 * 10 + 10
    high = -(-lack // box.width()) // 10 * 10 + 10
    across = [(wide, 0, 0, 0), (0, 0, wide, 0), (wide // 2, 0, wide // 2, 0)]
    along = [(0, high, 0, 0), (0, 0, 0, high), (0, high // 2, 0, high // 2)]
    made = [_corners(box, *sides) for sides in across + along]
    allowed = (one for others in (True, False) for one in made if view.clear(level, one, others))
    return next(allowed, None)
