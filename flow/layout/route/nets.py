"""A net from pin to pin: its paths, and the route along them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from ..geometry.boxes import Box, Boxes
from .access import accesses
from .area import meet_area
from .board import Board
from .route import Place, Point, Route
from .view import NetView, Straight

MARGINS_NM = (10_000, 40_000)  # of the window around two places to be joined: of a try, of the next
DETOUR_NM = 240_000  # the same where there was no path at all: round a block
REACH, JUMPER = 12, 20  # of a jumper's begin from its pin, of its end from there, in steps
SAMPLE = 8  # every such place of a path is looked at for the nearest one


@dataclass(frozen=True)
class Leg:
    """A path of a net with the routes into the pins that it joins. places: rows of the grid. pins: numbers."""

    places: Boxes
    route: Route
    pins: frozenset[int]


@dataclass(frozen=True)
class Found:
    """A route of a net, its legs, names of the nets in its way, and (level, Box) of where."""

    route: Route
    legs: Sequence[Leg]
    evicted: set[str]
    places: list[tuple[int, Box]]


@dataclass(frozen=True)
class End:
    """What is to be joined: a pin, met over one of ``ways``, or legs that are joined already and met anywhere."""

    ways: Mapping[Place, Route]
    pins: frozenset[int]

    @property
    def sample(self) -> Boxes:
        """Some of the places, an array."""
        return np.array(list(self.ways)[:: SAMPLE if not self.pins else len(self.ways)])


def route_net(
    board: Board, net: str, hasty: bool = False, kept: Sequence[Leg] = (), straight: Straight | None = None
) -> Found | None:
    """Route ``net``, which has no shapes on the ``board``, with the fewest nets in its way.

    hasty: whether the first path that there is will do. kept: legs that stay. straight: how short, if at all. None when
    there is no path past what is fixed, or no room for what a rule requires.
    """
    view = NetView(board, board.numbers[net], straight)
    try:
        return _best(view, net, hasty, kept)
    finally:
        view.release()


def _best(view: NetView, net: str, hasty: bool, kept: Sequence[Leg]) -> Found | None:
    if not view.board.jumpers[net] <= _jumped(view, net, kept):
        kept = ()  # they might be in a jumper's way
    for leg in kept:
        view.hold(leg.places)
    kept = [*kept, *_diodes(view, net, kept)]
    kept = [*kept, *_jumpers(view, net, kept)]
    ends, found, lacking = _ends(view, net, kept), [], []
    for margin in (*MARGINS_NM, DETOUR_NM) if all(end.ways for end in ends) else ():
        if found and margin == DETOUR_NM:
            break
        view.release()
        for leg in kept:
            view.hold(leg.places)
            if leg.pins & view.board.jumpers[net]:
                view.avoid(_below(leg.route, len(view.rules.layers) - 1))
        view.avoid(lacking)
        legs = _connected(view, ends, margin)
        if legs is None:
            continue
        route = Route.of(leg.route for leg in (*kept, *legs))
        if lack := meet_area(view, route):
            view.board.add_history(lack)
            lacking += lack
        else:
            found.append(Found(route, (*kept, *legs), *view.conflicts(route)))
            if hasty or not found[-1].evicted:
                break
    return min(found, key=lambda one: len(one.evicted), default=None)


def _below(route: Route, top: int) -> list[tuple[int, Box]]:
    """(level, box) of the segments below level ``top``."""
    return [(level, box) for level, made in route.segments.items() if level < top for box in made]


def clear_of(legs: Sequence[Leg], route: Route, board: Board) -> list[Leg]:
    """Those of ``legs`` that are not too near to another net's ``route``, nor meet a pin by way of one that is; none if
    no leg is too near."""
    near = [leg.route.near(route, board.rules) for leg in legs]
    pins = set[int]().union(*(leg.pins for leg, lost in zip(legs, near, strict=True) if lost))
    return [leg for leg, lost in zip(legs, near, strict=True) if not lost and not leg.pins & pins] if any(near) else []


def _diodes(view: NetView, net: str, kept: Sequence[Leg]) -> list[Leg]:
    """Legs from diodes that none of ``kept`` joins to their gates: charge must have a way down before others join."""
    joined, made = set[int]().union(*(leg.pins for leg in kept)), list[Leg]()
    for diode, gate in view.board.diodes.get(net, {}).items():
        if diode in joined:
            continue
        here, there = _ways(view, net, gate, [*kept, *made]), accesses(view, net, diode)
        if not here or not there:
            continue
        box = _box(*_nearest(view, *(np.array(list(ways)) for ways in (here, there)))[1:], MARGINS_NM[0])
        if path := view.search(box, list(here), list(there)):
            route = Route.of((here[path[0]], there[path[-1]]))
            route.draw(view.rules, path)
            made.append(Leg(np.array(path), route, frozenset((gate, diode))))
            view.hold(made[-1].places)
    return made


def _jumpers(view: NetView, net: str, kept: Sequence[Leg]) -> list[Leg]:
    """Legs from gates to the highest layer and along it: until that is made, little metal is joined to them."""
    top, made = len(view.rules.layers) - 1, list[Leg]()
    for number in view.board.jumpers[net] - _jumped(view, net, kept):
        ways = _ways(view, net, number, kept)
        if not ways:
            continue
        grid, (_, i, j), reach = view.board.grid, next(iter(ways)), range(-REACH, REACH + 1, 2)
        x, y = grid.at(i, j)
        path = view.search(
            _box((x, y), (x, y), MARGINS_NM[0]), list(ways), [(top, i + a, j + b) for a in reach for b in reach]
        )
        if path is None:
            continue
        _, i, j = path[-1]
        a, b = (JUMPER, 0) if view.rules.layers[top].horizontal else (0, JUMPER)
        column = _box(grid.at(i - a, j - b), grid.at(i + a, j + b), 0)
        run = grid.search(view.net, column, path[-1:], [(top, i - a, j - b), (top, i + a, j + b)])
        if run and all(level == top for level, *_ in run):
            route = Route.of((ways[path[0]],))
            route.draw(view.rules, [*path, *run[1:]])
            made.append(Leg(np.array([*path, *run[1:]]), route, frozenset((number,))))
            view.hold(made[-1].places)
    return made


def _jumped(view: NetView, net: str, kept: Sequence[Leg]) -> set[int]:
    """Pins that have a jumper."""
    return {pin for leg in kept for pin in leg.pins & view.board.jumpers[net] if len(_open(view, net, leg))}


def _ways(view: NetView, net: str, number: int, legs: Sequence[Leg]) -> Mapping[Place, Route]:
    """Ways into a pin: where one of ``legs`` has one that, for vias into one pin would be too near."""
    ways = accesses(view, net, number)
    taken = {tuple(place) for leg in legs if number in leg.pins for place in leg.places.tolist()}
    return dict.fromkeys(taken & ways.keys(), Route()) or ways


def _open(view: NetView, net: str, leg: Leg) -> Boxes:
    """Places of a leg that others may join: of one into a pin with a jumper the far end of this alone."""
    if not leg.pins & view.board.jumpers[net]:
        return leg.places
    return leg.places[-1:][leg.places[-1:, 0] == len(view.rules.layers) - 1]


def _ends(view: NetView, net: str, kept: Sequence[Leg]) -> list[End]:
    """What the legs ``kept`` come to, then the pins that none of them joins."""
    groups: list[tuple[set[Place], set[Place], set[int]]] = []  # places open to others, all, pins
    for leg in kept:
        group = *(set(map(tuple, places.tolist())) for places in (_open(view, net, leg), leg.places)), set(leg.pins)
        met = [other for other in groups if other[1] & group[1] or other[2] & group[2]]
        groups = [other for other in groups if other not in met]
        groups.append(tuple(one.union(*others) for one, *others in zip(group, *met, strict=True)))
    joined = set[int]().union(*(pins for *_, pins in groups))
    ends = [End(dict.fromkeys(places or every, Route()), frozenset()) for places, every, _ in groups]
    left = [number for number in range(len(view.board.pins[net])) if number not in joined]
    return ends + [End(accesses(view, net, number), frozenset([number])) for number in left]


def _connected(view: NetView, ends: Sequence[End], margin: int) -> list[Leg] | None:
    """Join the ``ends``, always the one nearest to what is joined, by legs; None without a path."""
    if trunk := len(ends) > 2 and bool(view.straight and view.straight.trunk):
        ends = _farthest_first(view, ends)
    legs, tree, first = list[Leg](), dict[Place, None](), ends[0]
    left = list(range(1, len(ends)))
    nearest = {k: _nearest(view, ends[k].sample, first.sample) for k in left}
    while left:
        k = 1 if trunk and not legs else min(left, key=lambda k: nearest[k][0])
        left.remove(k)
        box, sources = _box(*nearest[k][1:], margin), list(tree or first.ways)
        path = view.search(box, sources, list(ends[k].ways))
        if path is None:
            return None
        pins, route = ends[k].pins, Route()
        if not tree:
            pins |= first.pins
            route.join(first.ways[path[0]])
            tree |= {} if first.pins else dict.fromkeys(first.ways)
        route.join(ends[k].ways[path[-1]])
        route.draw(view.rules, path)
        new = path if ends[k].pins else [*path, *ends[k].ways]
        tree |= dict.fromkeys(new)
        legs.append(Leg(np.array(path), route, pins))
        view.hold(legs[-1].places)
        for other in left:
            closer = _nearest(view, ends[other].sample, np.array(new[::SAMPLE] + new[-1:]))
            nearest[other] = closer if closer[0] < nearest[other][0] else nearest[other]
    return legs


def _farthest_first(view: NetView, ends: Sequence[End]) -> list[End]:
    """The ``ends``, the two that are farthest from one another first."""
    pairs = combinations(range(len(ends)), 2)
    one, other = max(pairs, key=lambda pair: _nearest(view, *(ends[k].sample for k in pair))[0])
    return [ends[one], ends[other], *(end for k, end in enumerate(ends) if k not in (one, other))]


def _nearest(view: NetView, places: Boxes, joined: Boxes) -> tuple[int, Point, Point]:
    """(distance, points, nm) of the nearest two of two arrays of places."""
    here, there = (at[:, 1:] * np.array(view.rules.step) for at in (places, joined))
    distances = np.abs(here[:, None] - there[None]).sum(2)
    k, other = np.unravel_index(distances.argmin(), distances.shape)
    (a, b), (c, d) = here[k].tolist(), there[other].tolist()
    return int(distances[k, other]), (a, b), (c, d)


def _box(one: Point, other: Point, margin: int) -> Box:
    (a, b), (c, d) = one, other
    return min(a, c) - margin, min(b, d) - margin, max(a, c) + margin, max(b, d) + margin
