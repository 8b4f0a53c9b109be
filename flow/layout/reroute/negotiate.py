"""Nets that contend for room: who comes later takes it, who loses it is routed anew, and the place gets dearer for all.

That is the negotiation of PathFinder (McMurchie and Ebeling, FPGA 1995), begun from a layout that is nearly routed.
"""

from collections import Counter
from dataclasses import dataclass, field

from .board import nanometres
from .nets import routed

PATIENCE = 20  # nets that lose their places for every one that is asked for, at most
HOPS = 3  # times that a net is routed with hops; then it goes without, and keeps its antenna


@dataclass
class Bargain:
    """made: dict net -> Shapes of the nets routed anew. open: nets that are not. turns: of every net."""

    made: dict = field(default_factory=dict)
    open: list = field(default_factory=list)
    turns: Counter = field(default_factory=Counter)


def bargain(board, pins, wanted, hopping=(), held=None):
    """Route the nets ``wanted`` and every net that loses its place to them: a Bargain, and the ``board`` as it says.

    pins: dict net -> lists of boxes as coriolis.dump has them, of all nets on the board. hopping: nets routed with hops
    (see ``routed``) where there is room. held: Bargain that this one goes on with.
    """
    state = held or Bargain()
    waiting = sorted(wanted, key=lambda net: _span(pins[net]))
    for net in waiting:
        board.take(net)
    patience = PATIENCE * len(waiting)
    while waiting:
        net = waiting.pop(0)
        boxes = [[(board.levels[name], *nanometres(box)) for name, *box in pin] for pin in pins[net]]
        state.turns[net] += 1
        hops = net in hopping and state.turns[net] <= HOPS
        shapes, losers, places = (hops and routed(board, boxes, hops)) or routed(board, boxes) or (None, (), ())
        patience -= len(losers)
        if shapes is None or patience < 0:
            state.open.append(net)
            state.made.pop(net, None)
            continue
        for loser in losers:
            board.take(loser)
        board.fought(places)
        waiting += sorted(losers)
        board.put(net, shapes)
        state.made[net] = shapes
    return state


def _span(pins):
    """um, half the girth of the box around a net's pins."""
    boxes = [box for pin in pins for box in pin]
    return max(b[3] for b in boxes) - min(b[1] for b in boxes) + max(b[4] for b in boxes) - min(b[2] for b in boxes)
