"""The routing grid of a cell: vertices on half-site columns by the canvas's rows, and which exclude each other.

A vertex is (layer, column, row). Layers: poly between the diffusions (rows low and high), li everywhere, met1 where li
does not suffice, and the vias licon and mcon between them. On every layer neighbouring columns of one row are too near
to each other for different nets. Besides:

- ('pin', h, r): a pin on li from row r to r + 1; it holds these two vertices.
- ('tap', h, side, r): a gate's contact in row r, low or high, with its pin to the other of these rows, both 0.08 um
  next to the gate's centre (side -1 or 1), so that li of another net fits on the other side of it.
- ('tip', h, side, r): such a contact in row r, low or high, with li from it away from the other row, which joins
  column h + side there.
"""

import numpy as np
import numpy.typing as npt

from talbot.cells.compact.canvas import Canvas

Vertex = tuple[str, int, int] | tuple[str, int, int, int]
Neighbours = dict[Vertex, set[Vertex]]
Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
Flags = npt.NDArray[np.bool_]
Packed = tuple[Ints, Ints]  # start of each vertex's members, and the members
Arrays = tuple[Floats, Flags, Packed, Packed, Packed, Packed]  # price, leaf, next, excludes, needs, crowds

PRICE = {"li": 1.0, "poly": 2.0, "met1": 2.5, "licon": 2.0, "mcon": 4.0, "pin": 0.0, "tap": 3.0, "tip": 3.5}


class Grid:
    """The grid of ``columns`` half sites on ``canvas``, with or without met1.

    number: index of each of ``vertices``. Of a vertex, next: its neighbours; excludes: vertices that no other net may
    hold with it; needs: the vertices that it holds; crowds: those that the same net may not hold with it.
    """

    def __init__(self, columns: int, canvas: Canvas, met1: bool) -> None:
        self.columns, self.canvas = columns, canvas
        self.next: Neighbours = {}
        self.excludes: Neighbours = {}
        self.needs: Neighbours = {}
        self.crowds: Neighbours = {}
        for h in range(columns):
            self._column(h, met1)
        self.vertices = list(self.next)
        self.number = {v: i for i, v in enumerate(self.vertices)}
        for table in (self.excludes, self.crowds):
            for v in self.vertices:
                table[v] = {u for u in table.get(v, ()) if u in self.number}
            for v in self.vertices:
                for u in table[v]:
                    table[u].add(v)
        for v in self.vertices:
            self.excludes[v].add(v)
            self.crowds[v].discard(v)
            self.needs.setdefault(v, {v})

    def arrays(self) -> Arrays:
        """Return price, leaf, next, excludes, needs and crowds for the router."""
        price = np.array([PRICE[v[0]] for v in self.vertices])
        leaf = np.array([v[0] in ("pin", "tap") for v in self.vertices])
        pack = self._packed
        return price, leaf, pack(self.next), pack(self.excludes), pack(self.needs), pack(self.crowds)

    def _packed(self, table: Neighbours) -> Packed:
        members = [sorted(self.number[u] for u in table[v]) for v in self.vertices]
        start = np.cumsum([0, *(len(m) for m in members)])
        return start, np.array([u for m in members for u in m], dtype=np.int64)

    def _join(self, a: Vertex, b: Vertex) -> None:
        self.next.setdefault(a, set()).add(b)
        self.next.setdefault(b, set()).add(a)

    def _column(self, h: int, met1: bool) -> None:
        low, high, rows = self.canvas.low, self.canvas.high, len(self.canvas.rows)
        right = h + 1 < self.columns
        for r in range(rows):
            li = ("li", h, r)
            if r + 1 < rows:
                self._join(li, ("li", h, r + 1))
            if right:
                self._join(li, ("li", h + 1, r))
            if r in (low, high):
                self._join(("poly", h, r), ("licon", h, r))
                self._join(("licon", h, r), li)
                if right:
                    self._join(("poly", h, r), ("poly", h + 1, r))
                self.excludes[("poly", h, r)] = {("poly", h + 1, r)}
                self.crowds[("licon", h, r)] = {("licon", h + 1, r)}
            self.excludes[li] = {("li", h + 1, r)}
            if met1:
                self._join(li, ("mcon", h, r))
                self._join(("mcon", h, r), ("met1", h, r))
                if right:
                    self._join(("met1", h, r), ("met1", h + 1, r))
                self.excludes[("met1", h, r)] = {("met1", h + 1, r)}
                near: set[Vertex] = {("mcon", k, s) for k in (h - 1, h, h + 1) for s in (r - 1, r, r + 1)}
                self.excludes[("mcon", h, r)], self.crowds[("mcon", h, r)] = near, near
        self._join(("poly", h, low), ("poly", h, high))
        for r in self.canvas.pins:
            pin = ("pin", h, r)
            self.next.setdefault(pin, set())
            self.needs[pin] = {("li", h, r), ("li", h, r + 1)}
            for end in (r, r + 1):
                self.next.setdefault(("li", h, end), set()).add(pin)
        if h % 2:
            for side in (-1, 1):
                self._beside(h, side)

    def _beside(self, h: int, side: int) -> None:
        """Add the contacts of gate column ``h`` on ``side`` of its middle."""
        low, high = self.canvas.low, self.canvas.high
        here, other = (h, h + side), (h - 1, h, h + 1)
        for row, away in ((low, low - 1), (high, high + 1)):
            tap = ("tap", h, side, row)
            self.next.setdefault(tap, set())
            self.next.setdefault(("poly", h, row), set()).add(tap)
            stripe = {("li", k, r) for k in here for r in (away, low, high)}
            pads = {("licon", h + 2 * side, row), ("tap", h + 2 * side, -side, row), ("tip", h + 2 * side, -side, row)}
            self.excludes[tap] = stripe | pads
            beside = {(kind, h, s, r) for kind in ("tap", "tip") for s in (-1, 1) for r in (low, high)}
            self.crowds[tap] = stripe | {("licon", k, r) for k in other for r in (low, high)} | beside
        for row, away in ((low, low - 1), (high, high + 1)):
            tip = ("tip", h, side, row)
            self._join(("poly", h, row), tip)
            self._join(tip, ("li", h + side, away))
            pads = {("licon", h + 2 * side, row), ("tip", h + 2 * side, -side, row)}
            self.excludes[tip] = {("li", k, r) for k in here for r in (row, away)} | pads
            beside = {("tip", h, s, r) for s in (-1, 1) for r in (low, high)} | {("li", h, away)}
            self.crowds[tip] = {("licon", k, row) for k in other} | {("li", k, row) for k in here} | beside
