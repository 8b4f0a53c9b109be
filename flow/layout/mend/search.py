"""The cheapest way through a Window from one set of places to another: A*."""

import heapq

AGAINST = 3         # cost of a step against the direction of a layer's wires, in steps along it
CUT_NM = 2000       # cost of a cut, as that of so long a wire


def search(window, sources, targets, prices=None):
    """[(level, i, j), ...] from one of ``sources`` to one of ``targets`` (both sets of the same), or None.

    prices: dict level -> by how much its wires are dearer than others.
    """
    columns, rows = window.columns, window.rows
    layer = columns * rows
    wires = {level: free.tobytes() for level, free in window.wires.items()}
    cuts = {level: free.tobytes() for level, free in window.cuts.items()}
    steps = {}
    for level, made in enumerate(window.wiring.layers[1:], 1):
        x, y = (window.dx, window.dy * AGAINST) if made.across else (window.dx * AGAINST, window.dy)
        price = (prices or {}).get(level, 1)
        steps[level] = (rows, x * price), (1, y * price)

    def number(place):
        return place[0] * layer + place[1] * rows + place[2]

    ends = {number(place) for place in targets}
    low_i, high_i = min(t[1] for t in targets), max(t[1] for t in targets)
    low_j, high_j = min(t[2] for t in targets), max(t[2] for t in targets)

    def least(at):
        i, j = divmod(at, rows)
        return (max(low_i - i, i - high_i, 0) * window.dx + max(low_j - j, j - high_j, 0) * window.dy)

    cost = {number(place): 0 for place in sources}
    came = dict.fromkeys(cost)
    heap = [(least(place % layer), place) for place in cost]
    heapq.heapify(heap)
    done = set()
    while heap:
        _, here = heapq.heappop(heap)
        if here in ends:
            return [(n // layer, n % layer // rows, n % layer % rows) for n in _way(came, here)]
        if here in done:
            continue
        done.add(here)
        level, at = divmod(here, layer)
        now = cost[here]
        free = wires[level]
        for step, price in steps[level]:
            for there in (at - step, at + step):
                if free[there]:
                    _reach(cost, came, heap, here, level * layer + there, now + price, least(there))
        for below in (level - 1, level):
            if below in cuts and cuts[below][at]:
                _reach(cost, came, heap, here, here + (layer if below == level else -layer), now + CUT_NM, least(at))
    return None


def _reach(cost, came, heap, here, there, price, rest):
    if price < cost.get(there, 1 << 60):
        cost[there], came[there] = price, here
        heapq.heappush(heap, (price + rest, there))


def _way(came, end):
    way = []
    while end is not None:
        way.append(end)
        end = came[end]
    return way[::-1]
