"""Nets that contend for places: the later one takes them, evicted nets are rerouted, contested places cost more.

That is negotiated congestion as in PathFinder (McMurchie and Ebeling, FPGA 1995).
"""

import tempfile
from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import joblib

from talbot.base.gds import write_gds
from talbot.base.progress import line
from talbot.platforms.coriolis import CoriolisPlatform

from .board import GROWTH, PRESENT, Board
from .diodes import Diodes
from .nets import Leg, clear_of, route_net
from .route import Route
from .violations import Violations, find, find_in_file, split_levels

PATIENCE = 6  # evicted nets for every one that is to be routed, at most
TRIES = 3  # of a net without a path, while others move
HASTY_TRIES = 3  # of a net, which look for a path nearby alone
WHOLE = 4  # every such try of a net begins without the legs that nothing is in the way of
EASY = 4  # times that a net is routed before it costs others twice, and so on: those with other ways move
JOBS = 2  # in which the whole layout is checked
ROUNDS = 12  # of checks: a net that is evicted for another may get an antenna
TOLD = 100  # nets in a turn that takes seconds, of which a line is printed
MOST_BROKEN = 0.2  # share of the nets that a check may find to be rerouted


@dataclass
class Routed:
    """What a negotiation came to.

    routes: of the nets that were routed; legs: of these, what is left of them where they are evicted. open: nets
    without a route. tries, lost: of every net, how often it was routed at all, found no path. evictions: times that a
    net was. respaced: nets that were too near to others.
    """

    routes: dict[str, Route] = field(default_factory=dict)
    legs: dict[str, Sequence[Leg]] = field(default_factory=dict)
    open: list[str] = field(default_factory=list)
    tries: Counter[str] = field(default_factory=Counter)
    lost: Counter[str] = field(default_factory=Counter)
    evictions: int = 0
    respaced: set[str] = field(default_factory=set)


def negotiate(board: Board, wanted: Collection[str], state: Routed | None = None) -> Routed:
    """Route the nets ``wanted`` on the ``board`` and every net that they evict, turn by turn.

    state: what this call goes on with.
    """
    state = state or Routed()
    waiting = sorted(wanted, key=lambda net: -_hpwl(board, net))  # the long ones while there is room: found faster
    for net in waiting:
        if net not in state.legs:
            board.rip_up(net)
    board.charge(PRESENT)
    patience = PATIENCE * len(waiting) + 1000
    while waiting:
        if len(waiting) >= TOLD:
            line(f"{len(waiting)} nets to route")
        evicted = []
        for net in waiting:
            state.tries[net] += 1
            board.rip_up(net)
            kept = state.legs.pop(net, ()) if state.tries[net] % WHOLE else ()
            hasty = state.tries[net] <= HASTY_TRIES
            found = (route_net(board, net, hasty, kept) if kept else None) or route_net(board, net, hasty)
            if not found or patience < len(found.evicted):
                state.lost[net] += 1
                state.routes.pop(net, None)
                if found or state.lost[net] >= TRIES:
                    state.open.append(net)
                else:
                    evicted.append(net)
                continue
            patience -= len(found.evicted)
            state.evictions += len(found.evicted)
            for other in found.evicted:
                state.legs[other] = clear_of(state.legs.get(other, ()), found.route, board)
                board.put(other, Route.of(leg.route for leg in state.legs[other]))
            board.add_history(found.places)
            board.put(net, found.route, 1 + state.tries[net] // EASY)
            state.routes[net], state.legs[net] = found.route, found.legs
            evicted += sorted(found.evicted)
        waiting = list(dict.fromkeys(evicted))
        board.charge(GROWTH * board.present)
    return state


def _hpwl(board: Board, net: str) -> float:
    """Half-perimeter wire length of a net, nm."""
    boxes = [box for pin in board.pins[net] for box in pin]
    if not boxes:
        return 0
    return max(b[3] for b in boxes) - min(b[1] for b in boxes) + max(b[4] for b in boxes) - min(b[2] for b in boxes)


def route(board: Board, nets: Collection[str], tech: CoriolisPlatform, diodes: Diodes) -> Routed:
    """Route ``nets``, check, and route those with a violation again, with a diode or a jumper against an antenna."""
    state, changed = negotiate(board, nets), None
    for _ in range(ROUNDS):
        if state.open:
            break
        found = check(board, tech) if changed is None else find(board.part(changed), board.rules, tech)
        near, charged = found.nets(board, changed)
        state.respaced |= {*near}
        if len({*near, *(net for net, _ in charged)}) > MOST_BROKEN * len(board.nets):
            break
        relieved = {net for net, gate in charged if diodes.relieve(board, net, gate)}
        wanted = {*near, *relieved}
        if not wanted:
            break
        before = dict(state.routes)
        for net in near:
            state.legs.pop(net, None)
        board.add_history((level, box) for level, *edges in found.spacing for box in edges)  # else the same again
        negotiate(board, wanted, state)
        changed = {net for net, made in state.routes.items() if made is not before.get(net)}
    return state


def check(board: Board, tech: CoriolisPlatform) -> Violations:
    """Violations of the whole layout, found in JOBS processes."""
    with tempfile.TemporaryDirectory() as folder:
        gds = Path(folder) / "routed.gds"
        write_gds(board.drawn(), gds)
        tasks = (joblib.delayed(find_in_file)(gds, board.rules, tech, at) for at in split_levels(board.rules, JOBS))
        found: Any = joblib.Parallel(n_jobs=JOBS)(tasks)
    return sum(found, Violations())
