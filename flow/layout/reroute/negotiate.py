"""Nets that contend for places: the later one takes them, evicted nets are rerouted, contested places cost more.

That is negotiated congestion as in PathFinder (McMurchie and Ebeling, FPGA 1995), begun from a layout that is nearly
routed.
"""

from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import joblib

from platforms.coriolis import CoriolisPlatform

from .board import Board, nanometres
from .nets import route_net
from .route import Route
from .violations import Violations, find, find_in_file, split_levels

PATIENCE = 20  # evicted nets for every one that is to be routed, at most
JUMPER_TRIES = 3  # times that a net is routed with antenna jumpers; then it goes without, and keeps its antenna
JOBS = 2  # in which the router's layout is checked
ROUNDS = 12  # a net that is evicted for another may get an antenna

Pins = Mapping[str, Sequence[Sequence[Sequence[Any]]]]  # by net and pin (layer, left, bottom, right, top), um


@dataclass
class Rerouted:
    """Nets after rip-up and reroute.

    routes: of the nets that were rerouted. open: nets without a route. tries: of every net. respaced, charged: nets
    that were too near to others, nets that had an antenna.
    """

    routes: dict[str, Route] = field(default_factory=dict)
    open: list[str] = field(default_factory=list)
    tries: Counter[str] = field(default_factory=Counter)
    respaced: set[str] = field(default_factory=set)
    charged: set[str] = field(default_factory=set)


def negotiate(board: Board, pins: Pins, wanted: Collection[str], state: Rerouted | None = None) -> Rerouted:
    """Route the nets ``wanted`` on the ``board`` and every net that they evict.

    pins: of all nets on the board. state: what this call goes on with; its ``charged`` nets are routed with antenna
    jumpers where there is room.
    """
    state = state or Rerouted()
    waiting = sorted(wanted, key=lambda net: _hpwl(pins[net]))
    for net in waiting:
        board.rip_up(net)
    patience = PATIENCE * len(waiting)
    while waiting:
        net = waiting.pop(0)
        boxes = [[(board.levels[name], *nanometres(box)) for name, *box in pin] for pin in pins[net]]
        state.tries[net] += 1
        jumpers = net in state.charged and state.tries[net] <= JUMPER_TRIES
        found = (jumpers and route_net(board, boxes, jumpers)) or route_net(board, boxes)
        patience -= len(found.evicted) if found else 0
        if not found or patience < 0:
            state.open.append(net)
            state.routes.pop(net, None)
            continue
        for evicted in found.evicted:
            board.rip_up(evicted)
        board.add_history(found.places)
        waiting += sorted(found.evicted)
        board.put(net, found.route)
        state.routes[net] = found.route
    return state


def _hpwl(pins: Sequence[Sequence[Sequence[Any]]]) -> float:
    """Half-perimeter wire length of a net, um."""
    boxes = [box for pin in pins for box in pin]
    return max(b[3] for b in boxes) - min(b[1] for b in boxes) + max(b[4] for b in boxes) - min(b[2] for b in boxes)


def reroute(board: Board, pins: Pins, left: Sequence[str], most: int, gds: Path, tech: CoriolisPlatform) -> Rerouted:
    """Reroute the nets ``left`` open by the router, then those with a violation; none if over ``most``.

    The router's layout, the file ``gds``, is checked in other processes meanwhile; later only the rerouted nets are,
    and the nets that open ones had a short to.
    """
    if len(left) > most:
        return Rerouted(open=list(left))
    before, shorted = dict(board.routed), board.touching(left)
    first: Any = joblib.Parallel(n_jobs=JOBS, return_as="generator")(
        [joblib.delayed(find_in_file)(gds, board.rules, tech, levels) for levels in split_levels(board.rules, JOBS)]
    )
    state = negotiate(board, pins, left)
    rest = [net for net in board.nets if net not in {*state.routes, *shorted}]
    near, charged = sum(first, Violations()).nets(board, before, rest)
    for _ in range(ROUNDS):
        changed = {*state.routes, *shorted}
        fresh = find(board.part(changed), board.rules, tech).nets(board, board.routed, changed)
        near, charged = {*near, *fresh[0]}, {*charged, *fresh[1]}
        state.respaced |= near
        state.charged |= charged
        wanted = sorted(near | charged)
        if state.open or not wanted or len(wanted) > most:
            break
        negotiate(board, pins, wanted, state)
        near, charged = (), ()
    return state
