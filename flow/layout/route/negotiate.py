"""Nets that contend for places: the later one takes them, evicted nets are rerouted, contested places cost more.

That is negotiated congestion as in PathFinder (McMurchie and Ebeling, FPGA 1995).
"""

import tempfile
from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import joblib

from talbot.base.gds import write_gds
from talbot.base.progress import line
from talbot.platforms.coriolis import CoriolisPlatform

from .board import GROWTH, PRESENT, Board
from .diodes import Diodes
from .nets import Found, Leg, clear_of, route_net
from .route import Route
from .view import Straight
from .violations import Violations, find, find_in_file, split_levels

# Evicted nets, at most: for every one that is to be routed; more, and where a net is to get shorter
PATIENCE, ALLOWED, ALLOWED_SHORTER = 6, 1000, 150
TRIES = 3  # of a net without a path, while others move
HASTY_TRIES = 3  # of a net, which look for a path nearby alone
WHOLE = 4  # every such try of a net begins without the legs that nothing is in the way of
EASY = 4  # times that a net is routed before it costs others twice, and so on: those with other ways move
JOBS = 2  # in which the whole layout is checked
MANY = 3000  # nets: the processes for fewer take longer to begin than to check
ROUNDS = 12  # of checks: a net that is evicted for another may get an antenna
TOLD = 100  # nets in a turn that takes seconds, of which a line is printed
# What a net that is too long may do, turn by turn: it first goes around others at a small cost, then hardly
STRAIGHT = tuple(Straight(nm, trunk) for nm in (500, 100) for trunk in (False, True))
PROTECTED = 8  # weight of a net that was straightened
# Weight, from the start, of a net that may be no longer than so many of its half perimeters: others go around it
TIGHT, HELD = 1.75, 4
MOST_EVICTED = 40  # nets in the way of one that is to get shorter
MOST_BROKEN = 0.2  # share of the nets that a check may find to be rerouted


@dataclass
class Routed:
    """What a negotiation came to.

    routes: of the nets that were routed; legs: of these, what is left of them where they are evicted. open: nets
    without a route. tries, lost: of every net, how often it was routed at all, found no path. evictions: times that a
    net was. respaced: nets that were too near to others. bent: nets that `straighten` tried to make shorter, long: that
    are longer than allowed. tight: that have a weight of HELD.
    """

    routes: dict[str, Route] = field(default_factory=dict)
    legs: dict[str, Sequence[Leg]] = field(default_factory=dict)
    open: list[str] = field(default_factory=list)
    tries: Counter[str] = field(default_factory=Counter)
    lost: Counter[str] = field(default_factory=Counter)
    evictions: int = 0
    respaced: set[str] = field(default_factory=set)
    bent: set[str] = field(default_factory=set)
    long: set[str] = field(default_factory=set)
    tight: Collection[str] = ()


def negotiate(board: Board, wanted: Collection[str], state: Routed | None = None, allowed: int = ALLOWED) -> Routed:
    """Route the nets ``wanted`` on the ``board`` and every net that they evict, turn by turn.

    state: what this call goes on with. allowed: evicted nets beyond PATIENCE.
    """
    state = state or Routed()
    waiting = sorted(wanted, key=lambda net: -_hpwl(board, net))  # the long ones while there is room: found faster
    for net in waiting:
        if net not in state.legs:
            board.rip_up(net)
    board.charge(PRESENT)
    patience = PATIENCE * len(waiting) + allowed
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
            place(board, net, found, state, (HELD if net in state.tight else 1) + state.tries[net] // EASY)
            evicted += sorted(found.evicted)
        waiting = list(dict.fromkeys(evicted))
        if waiting:
            board.charge(GROWTH * board.present)
    return state


def place(board: Board, net: str, found: Found, state: Routed, weight: int) -> None:
    """Put ``net`` on the board as ``found``, the nets in its way off it but for their legs that are clear of it."""
    state.evictions += len(found.evicted)
    for other in found.evicted:
        state.legs[other] = clear_of(state.legs.get(other, ()), found.route, board)
        board.put(other, Route.of(leg.route for leg in state.legs[other]))
    board.add_history(found.places)
    board.put(net, found.route, weight)
    state.routes[net], state.legs[net] = found.route, found.legs


def straighten(board: Board, state: Routed, most: Mapping[str, float]) -> set[str]:
    """Route nets that are longer than ``most`` (um) again, shorter, those in their way around them; which still are.

    A net stays as it was where some net then has no route, or nets are longer than allowed by as much in sum.
    """
    left = _long(state.routes, most, state.routes)
    if left:
        line(f"{len(left)} nets to shorten")
    for net in sorted(left.keys() - state.bent, key=lambda net: -left[net]):
        state.bent.add(net)
        for straight in STRAIGHT:
            if net not in _long(state.routes, most, [net]) or _straightened(board, net, straight, state, most):
                break
        line(f"{net}: {left[net]:.1f} um too long, then {_long(state.routes, most, [net]).get(net, 0):.1f}")
    return {*_long(state.routes, most, state.routes)}


def _long(routes: Mapping[str, Route], most: Mapping[str, float], nets: Iterable[str]) -> dict[str, float]:
    """Those of ``nets`` that are too long, and by how much (um)."""
    over = {net: routes[net].nm / 1000 - most[net] for net in nets if net in routes and net in most}
    return {net: um for net, um in over.items() if um > 0}


def _straightened(board: Board, net: str, straight: Straight, state: Routed, most: Mapping[str, float]) -> bool:
    """Whether ``net`` got shorter and others are not longer than allowed for it; else all is as before."""
    routes, legs, lost, weights = dict(state.routes), dict(state.legs), Counter(state.lost), dict(board.weights)
    board.charge(PRESENT)
    board.rip_up(net)
    found = route_net(board, net, straight=straight)
    if not found or found.route.nm >= routes[net].nm or len(found.evicted) > MOST_EVICTED:
        board.put(net, routes[net])
        return False
    place(board, net, found, state, PROTECTED)
    negotiate(board, found.evicted, state, ALLOWED_SHORTER)
    changed = {other for other in routes if state.routes.get(other) is not routes[other]}
    now, before = (sum(_long(made, most, changed).values()) for made in (state.routes, routes))
    if not state.open and now < before:
        return True
    for other in changed:
        board.put(other, routes[other], weights.get(other, 1))
    state.routes, state.legs, state.lost, state.open = routes, legs, lost, []
    return False


def _hpwl(board: Board, net: str) -> float:
    """Half-perimeter wire length of a net, nm."""
    boxes = [box for pin in board.pins[net] for box in pin]
    if not boxes:
        return 0
    return max(b[3] for b in boxes) - min(b[1] for b in boxes) + max(b[4] for b in boxes) - min(b[2] for b in boxes)


def route(
    board: Board, nets: Collection[str], tech: CoriolisPlatform, diodes: Diodes, most: Mapping[str, float] | None = None
) -> Routed:
    """Route ``nets``, check, and route those with a violation again, with a diode or a jumper against an antenna.

    most: um of nets, which `straighten` sees to.
    """
    tight = {net for net, um in (most or {}).items() if net in board.pins and 1000 * um < TIGHT * _hpwl(board, net)}
    state, before = negotiate(board, nets, Routed(tight=tight)), None
    for _ in range(ROUNDS):
        if state.open:
            break
        state.long = straighten(board, state, most or {})
        changed = before and {net for net, made in state.routes.items() if made is not before.get(net)}
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
    return state


def check(board: Board, tech: CoriolisPlatform) -> Violations:
    """Violations of the whole layout, one of many nets found in JOBS processes."""
    with tempfile.TemporaryDirectory() as folder:
        gds = Path(folder) / "routed.gds"
        write_gds(board.drawn(), gds)
        tasks = (joblib.delayed(find_in_file)(gds, board.rules, tech, at) for at in split_levels(board.rules, JOBS))
        found: Any = joblib.Parallel(n_jobs=JOBS if len(board.nets) > MANY else 1)(tasks)
    return sum(found, Violations())
