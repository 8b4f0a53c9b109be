"""The rectangles of a cell: transistors, taps, rails and routes."""

from collections import defaultdict
from collections.abc import Collection, Iterable
from typing import NamedTuple, NotRequired, TypedDict

from talbot.base.gds import db
from talbot.cells.compact.assemble import Assembly
from talbot.cells.compact.canvas import Canvas
from talbot.cells.compact.grid import Vertex
from talbot.cells.compact.route import Wiring

CUT, WIRE = 0.17, 0.17  # um: licon and mcon; li
PAD = (0.27, 0.33)  # um: poly around its contact
PATCH = 0.33  # um: li around a contact, along one direction
SHIFT = 0.08  # um: from a gate to its 'tap' contact (route)
EPSILON = 1e-6
VIA_PAD = (0.29, 0.23)  # um: met1 around mcon
THRESHOLD = 0.18  # um: high-threshold implant around a p gate (hvtp.3)


class Shape(NamedTuple):
    """A rectangle (um) on a layer of PDKMaster's technology. net: its net, '' for wells, implants and the like."""

    layer: str
    net: str
    left: float
    bottom: float
    right: float
    top: float

    @property
    def nm(self) -> "db.Box":
        """The rectangle in nm."""
        return db.Box(*(round(v * 1000) for v in (self.left, self.bottom, self.right, self.top)))


class Drawn(TypedDict):
    """A cell as JSON holds it: width in um, fields of its shapes and of its Recipe, sides of a diode."""

    width: float
    shapes: list[tuple[str, str, float, float, float, float]]
    recipe: NotRequired[list[object]]
    diode: NotRequired[tuple[float, float]]


class Reach(NamedTuple):
    """A pin on li: its middle, bottom and top in um."""

    x: float
    bottom: float
    top: float


class Pen:
    """Draws rectangles into ``shapes``, in um; the cell is ``sites`` wide."""

    def __init__(self, canvas: Canvas, sites: int) -> None:
        self.canvas, self.width = canvas, sites * canvas.site
        self.shapes: list[Shape] = []

    def box(self, layer: str, net: str, left: float, bottom: float, right: float, top: float) -> None:
        """Add a rectangle by its sides, on the grid of 5 nm."""
        left, bottom, right, top = (round(round(v / 0.005) * 0.005, 3) for v in (left, bottom, right, top))
        self.shapes.append(Shape(layer, net, left, bottom, right, top))

    def at(self, layer: str, net: str, x: float, y: float, width: float, height: float) -> None:
        """Add a rectangle by its middle."""
        self.box(layer, net, x - width / 2, y - height / 2, x + width / 2, y + height / 2)


class Drawing(Pen):
    """The shapes of a placed and routed cell. reach: with pins as long as their neighbours allow."""

    def __init__(self, canvas: Canvas, assembly: Assembly, wiring: Wiring, reach: bool = True) -> None:
        super().__init__(canvas, (assembly.columns + 1) // 2)
        self.assembly, self.wiring = assembly, wiring
        frame(self)
        self._transistors()
        self._rail_stubs()
        for net in wiring.vertices:
            self._wires(net)
        pins = {net: self._pin(net, pin) for net, pin in wiring.pins.items()}
        for net, pin in pins.items():
            x, bottom, top = self._reach(net, pin) if reach else pin
            for layer in ("li", "li.pin"):
                self.box(layer, net, x - WIRE / 2, bottom, x + WIRE / 2, top)
        inside = [s for s in self.shapes if s.layer == "m1" and s.net not in ("vdd", "vss")]
        self.shapes += [s._replace(layer="m1.block", net="") for s in inside]

    def x(self, h: int) -> float:
        """The middle of half-site column ``h``, um."""
        return (h + 1) * self.canvas.site / 2

    def _transistors(self) -> None:
        c, half = self.canvas, self.canvas.length / 2
        for h, column in self.assembly.gates:
            left, right = self.x(h) - half, self.x(h) + half
            self.box("poly", column.n.gate, left, c.n[0] - 0.13, right, c.rows[c.low] + half)
            self.box("poly", column.p.gate, left, c.rows[c.high] - half, right, c.p[1] + 0.13)
        gates = {h for h, _ in self.assembly.gates}
        for d in self.assembly.diffusions:
            low, high = c.n if d.kind == "n" else c.p
            start, end = min(d.columns), max(d.columns)
            left = self.x(start) - (0.26 if start - 1 in gates else 0.125)
            right = self.x(end) + (0.26 if end + 1 in gates else 0.125)
            self.box("difftap", d.net, left, low, right, high)

    def _rail_stubs(self) -> None:
        for net, edge in (("vss", 0.0), ("vdd", self.canvas.height)):
            for _, h, r, *_ in self.wiring.vertices.get(net, ()):
                y = self.canvas.rows[r]
                self.box("li", net, self.x(h) - WIRE / 2, min(y, edge), self.x(h) + WIRE / 2, max(y, edge))

    def _wires(self, net: str) -> None:
        vertices, edges = self.wiring.vertices[net], self.wiring.edges.get(net, [])
        contacts: set[Vertex] = {("poly", v[1], v[2]) for v in vertices if v[0] == "licon"}
        for layer, h, r, *more in vertices:
            x, y = self.x(h), self.canvas.rows[r] if layer not in ("tap", "tip") else 0.0
            if layer == "tip":
                self._tip(net, h, r, *more)
            elif layer == "li":
                self.at("li", net, x, y, WIRE, WIRE)
            elif layer == "licon":
                self.at("poly", net, x, y, *PAD)
                self.at("licon", net, x, y, CUT, CUT)
                self.at("li", net, x, y, PATCH, WIRE)
            elif layer == "mcon":
                self.at("mcon", net, x, y, CUT, CUT)
                self.at("m1", net, x, y, *VIA_PAD)
        for a, b in edges:
            if a[0] == b[0] and a[0] in ("li", "poly", "met1"):
                self._segment(net, a, b, contacts)
        self._diffusion_contacts(net)
        self._fill(net, vertices)

    def _segment(self, net: str, a: Vertex, b: Vertex, contacts: set[Vertex]) -> None:
        layer, width = {"li": ("li", WIRE), "poly": ("poly", self.canvas.length), "met1": ("m1", 0.14)}[a[0]]
        half = width / 2
        # A pad next to a gate: no notch between the two
        tall = PAD[1] / 2 if a[0] == "poly" and a[2] == b[2] and {a, b} & contacts else half
        x = sorted((self.x(a[1]), self.x(b[1])))
        y = sorted((self.canvas.rows[a[2]], self.canvas.rows[b[2]]))
        self.box(layer, net, x[0] - half, y[0] - tall, x[1] + half, y[1] + tall)

    def _beside(self, net: str, h: int, side: int, row: int) -> float:
        """Draw a gate's contact and its poly pad, SHIFT from the gate's centre; returns its x."""
        x, y = self.x(h) + side * SHIFT, self.canvas.rows[row]
        self.at("poly", net, x, y, *PAD)
        self.box("poly", net, min(x, self.x(h)), y - PAD[1] / 2, max(x, self.x(h)), y + PAD[1] / 2)
        self.at("licon", net, x, y, CUT, CUT)
        return x

    def _tip(self, net: str, h: int, side: int, row: int) -> None:
        c = self.canvas
        x, y = self._beside(net, h, side, row), c.rows[row]
        step = -1 if row == c.low else 1
        away, back, forth = c.rows[row + step], -step * PATCH / 2, step * WIRE / 2
        self.box("li", net, x - WIRE / 2, min(y + back, away + forth), x + WIRE / 2, max(y + back, away + forth))
        ends = sorted((x, self.x(h + side)))
        self.box("li", net, ends[0] - WIRE / 2, away - WIRE / 2, ends[1] + WIRE / 2, away + WIRE / 2)

    def _diffusion_contacts(self, net: str) -> None:
        for d in self.assembly.diffusions:
            row = 0 if d.kind == "n" else len(self.canvas.rows) - 1
            for h in d.columns if d.net == net else ():
                if ("li", h, row) in self.wiring.vertices[net]:
                    self.at("licon", net, self.x(h), self.canvas.rows[row], CUT, CUT)
                    self.at("li", net, self.x(h), self.canvas.rows[row], PATCH, WIRE)

    def _fill(self, net: str, vertices: Collection[Vertex]) -> None:
        """Fill the gaps between routes of one net side by side."""
        rows = self.canvas.rows
        edges = [e for e in self.wiring.edges.get(net, ()) if e[0][0] == e[1][0] == "li" and e[0][1] == e[1][1]]
        upright = {(e[0][1], min(e[0][2], e[1][2])) for e in edges}
        for layer, h, r, *_ in (v for v in vertices if v[0] in ("li", "poly", "met1")):
            if (layer, h + 1, r) not in vertices:
                continue
            name, height = {"li": ("li", WIRE), "poly": ("poly", PAD[1]), "met1": ("m1", 0.14)}[layer]
            self.box(name, net, self.x(h), rows[r] - height / 2, self.x(h + 1), rows[r] + height / 2)
            if layer == "li" and {(h, r), (h + 1, r)} <= upright:
                self.box("li", net, self.x(h), rows[r], self.x(h + 1), rows[r + 1])

    def _pin(self, net: str, pin: Vertex) -> Reach:
        """The pin as it was routed."""
        c = self.canvas
        kind, h, r, *row = pin
        if kind == "tap":
            x, low, high = self._beside(net, h, r, *row), c.rows[c.low], c.rows[c.high]
            ends = (PATCH, WIRE) if row == [c.low] else (WIRE, PATCH)
            bottom, top = low - ends[0] / 2, high + ends[1] / 2
        else:
            x, low, high = self.x(h), r, r
            edges = [sorted(e) for e in self.wiring.edges[net] if e[0][:2] == e[1][:2] == ("li", h)]
            joined = {below[2] for below, _ in edges}  # rows from which li runs on to the next one
            while high in joined:
                high += 1
            while low - 1 in joined:
                low -= 1
            bottom, top = c.rows[low] - WIRE / 2, c.rows[high] + WIRE / 2
        return Reach(x, bottom, top)

    def _reach(self, net: str, pin: Reach) -> Reach:
        """Extend the pin to where li of another net, or another piece of its net, begins."""
        x, bottom, top = pin
        low, high = self.canvas.li_rail + WIRE, self.canvas.height - self.canvas.li_rail - WIRE
        for s in self.shapes:
            same_net = s.net == net and s.left < x + WIRE / 2 - EPSILON and s.right > x - WIRE / 2 + EPSILON
            if s.layer != "li" or same_net or s.left > x + 1.5 * WIRE - EPSILON or s.right < x - 1.5 * WIRE + EPSILON:
                continue
            if s.bottom > top - EPSILON:
                high = min(high, s.bottom - WIRE)
            if s.top < bottom + EPSILON:
                low = max(low, s.top + WIRE)
        return Reach(x, min(bottom, low), max(top, high))


def frame(drawing: Pen) -> None:
    """Draw what every cell has: rails with taps under them, well and implants."""
    c, width = drawing.canvas, drawing.width
    for net, y in (("vss", 0.0), ("vdd", c.height)):
        drawing.box("difftap", net, 0, y - c.tap, width, y + c.tap)
        drawing.box("li", net, 0, y - c.li_rail, width, y + c.li_rail)
        drawing.box("m1", net, 0, y - c.rail, width, y + c.rail)
        inside = (y, y + c.rail) if net == "vss" else (y - c.rail, y)
        drawing.box("m1.pin", net, 0, inside[0], width, inside[1])
        for k in range(round(width / c.site)):
            x = (k + 0.5) * c.site
            drawing.at("licon", net, x, y, CUT, CUT)
            drawing.at("mcon", net, x, y, CUT, CUT)
    drawing.box("psdm", "", -0.13, -c.implant, width + 0.13, c.implant)
    drawing.box("nsdm", "", -0.13, c.n[0] - 0.125, width + 0.13, c.n[1] + 0.125)
    drawing.box("psdm", "", -0.13, c.p[0] - 0.125, width + 0.13, c.p[1] + 0.125)
    drawing.box("nsdm", "", -0.13, c.height - c.implant, width + 0.13, c.height + c.implant)
    drawing.box("nwm", "vdd", -0.18, c.well, width + 0.18, c.height + 0.31)


def threshold(canvas: Canvas, width: float) -> Shape:
    """Return the implant of high-threshold p transistors, no wider than the cell: its neighbours may be plain."""
    return Shape("hvtp", "", 0.0, round(canvas.p[0] - THRESHOLD, 3), width, round(canvas.p[1] + THRESHOLD, 3))


def regions(shapes: Iterable[Shape]) -> "dict[str, db.Region]":
    """The region of every layer in ``shapes``, in nm."""
    by_layer = defaultdict(db.Region)
    for s in shapes:
        by_layer[s.layer].insert(s.nm)
    return by_layer
