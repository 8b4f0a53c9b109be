"""One pixel drawn: two photodiodes under the gratings of its type, and the transistors that read them.

    +------------------+------------------+   Each half has an n well as photodiode, under a grating over an analyzer
    | well a   bar     |  well b      bar |   that is half a period farther on in the other half. Bars of the upper
    | analyzer  |      |  analyzer     |  |   grating's metal keep light from what is between the wells; the supply's
    | grating   |      |  grating      |  |   plate on the metal below keeps it from the transistors. Columns and supply
    +-----------+------+---------------+--+   run up between the two halves, rows across the strip of transistors.
    | reset follower select   (mirrored)  |
    +-------------------------------------+

The n well, and not n+ in the substrate: it has a fifteenth of the capacitance of an area and half of that of the whole
diode, and its junction is deep where green and red light are absorbed (silicon: 1.1 um at 550 nm).
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from talbot.base.gds import db
from talbot.models.parameters import ParameterError, PixelType, check_real
from talbot.pixels.optics.fit import Fit
from talbot.pixels.optics.geometry import QUADRATURE, PixelGeometry
from talbot.pixels.tabled import rows
from talbot.platforms.optics import Metal
from talbot.platforms.pixel import PixelProcess, pixel_process

from .canvas import Canvas
from .circuit import Circuit, circuit
from .gratings import Lines, lines, polygons

# um. Of the wells: half of the space between two, the strip of transistors below, the space to the next pixel's strip
BESIDE, STRIP, ABOVE = 0.65, 2.95, 0.05
WINDOW_BESIDE, WINDOW_BELOW, WINDOW_ABOVE = 0.75, 3.05, 0.15  # of the gratings, from the half's edges
BAR, SHIELD = 0.45, (0.2, 1.3)  # half a bar's width; bottom and top of what joins the bars
PLATE = 0.45, 2.70  # bottom and top of the supply's plate
RESET_Y, READ_Y, LINE = 0.5, 2.38, 0.2  # the rows' lines: middles and width
COLUMN = 0.5  # of the columns' lines from the pixel's middle
DIFFUSION = 0.90, 3.80, 0.95  # left, right and bottom of the transistors
IMPLANT, TAP, TAP_TALL = 0.125, 0.36, 0.42  # around diffusion; a tap's width and height
TAP_Y = 3.40
END = 0.165  # of poly beyond the middle of a contact
LEAST_PITCH = 10.0
UPPER, COLUMNS, PLATES, ROWS_ON = 4, 2, 3, 1  # metals by their place in the process's table


@dataclass(frozen=True)
class PixelLayout:
    """What a pixel is drawn from: the gratings that the optics solved, its type, how its analyzers follow from both.

    geometry: an amplitude pixel. kind: the type. diodes: rows of `Response` for the two diodes, of 0..3 quarter periods
    (`talbot.pixels.tabled.rows`). w_um, l_um: of the transistors. Raises ParameterError for what is not drawn.
    """

    geometry: PixelGeometry
    kind: PixelType
    diodes: tuple[int, int]
    w_um: float = field(default=1.0, metadata={"unit": "um"})
    l_um: float = field(default=0.5, metadata={"unit": "um"})

    def __post_init__(self) -> None:
        process, g = self.process, self.geometry
        if g.kind != "amplitude":
            raise ParameterError(f"kind = {g.kind!r}: must be amplitude for a drawn pixel")
        check_real("pitch_um", g.pitch_um, LEAST_PITCH, 100)
        check_real("w_um", self.w_um, 0.42, 1.0)
        check_real("l_um", self.l_um, 0.5, 0.5)
        if process.level(g.diffraction) != UPPER or process.level(g.analyzer or "") >= PLATES:
            names = [metal.lef for metal in process.metals]
            raise ParameterError(
                f"diffraction, analyzer = {g.diffraction}, {g.analyzer}: must be {names[UPPER]} over "
                f"{names[ROWS_ON]} or {names[COLUMNS]} for a drawn pixel"
            )

    @property
    def process(self) -> PixelProcess:
        """The masks. Raises ParameterError."""
        return pixel_process(self.geometry.process)

    @property
    def name(self) -> str:
        """Name of its cell: beta, gamma and alpha in degrees, p for plus and m for minus."""
        gamma = f"{'m' if self.kind.gamma_deg < 0 else 'p'}{abs(self.kind.gamma_deg):g}".replace(".", "d")
        return f"pixel_{self.kind.beta:g}_{gamma}_{round(np.rad2deg(self.kind.alpha)):d}"

    @property
    def well_um(self) -> tuple[float, float]:
        """Width and height of a diode."""
        pitch = self.geometry.pitch_um
        return pitch / 2 - 2 * BESIDE, pitch - STRIP - ABOVE

    @property
    def circuit(self) -> Circuit:
        """The pixel's circuit."""
        return circuit(self.well_um, self.w_um, self.l_um)

    @property
    def gates_um(self) -> tuple[float, float, float]:
        """Left edges of the gates of reset, follower and select along x, in the pixel's western half."""
        node, supply, _ = _contacts(self)
        return node + 0.205, supply + 0.205, supply + 0.505 + self.l_um

    @property
    def node_wire_um(self) -> tuple[float, float]:
        """Area in um2 and perimeter in um of a diode's node on the lowest metal: to the follower's gate and the tap."""
        node, (_, _, bottom), follower = _contacts(self)[0], DIFFUSION, self.gates_um[1] + self.l_um / 2
        upright, across = TAP_Y - bottom - 0.5, follower - node - 0.085
        return 0.17 * (upright + across), 2 * (upright + across + 0.17)

    @property
    def fill_factor(self) -> float:
        """Share of the pixel that is photodiode."""
        width, height = self.well_um
        return 2 * width * height / self.geometry.pitch_um**2

    def gratings(self) -> tuple[Lines, Lines]:
        """The upper grating and the analyzer on the manufacturing grid, of one pitch. Raises ParameterError.

        The sensor's y runs from row to row, down; the layout's up: gamma changes its sign.
        """
        g, grid = self.geometry, self.process.grid_um
        stack, normal = g.stack, -self.kind.gamma
        upper, lower = stack.metal("diffraction", g.diffraction), stack.metal("analyzer", g.analyzer or "")

        def fitted(metal: Metal, fill: float) -> Lines:
            return lines(normal, g.period_um / grid, fill, metal.width_um / grid, metal.space_um / grid)

        found = fitted(upper, g.fill), fitted(lower, g.analyzer_fill)
        pitch = max(of.pitch for of in found)
        return replace(found[0], pitch=pitch), replace(found[1], pitch=pitch)

    @property
    def drawn(self) -> PixelGeometry:
        """The geometry with the period and the fills that are drawn, on the grid and under the rules."""
        upper, lower = self.gratings()
        return replace(
            self.geometry,
            period_um=round(upper.period * self.process.grid_um, 6),
            fill=upper.fill,
            analyzer_fill=lower.fill,
        )


def pixel_layout(geometry: PixelGeometry, kind: PixelType, found: Fit) -> PixelLayout:
    """A type on its gratings. found: Eq. 3.1 fitted to them, which says where its analyzers are."""
    return PixelLayout(geometry, kind, rows(kind.alpha, found))


def draw(layout: "db.Layout", made: PixelLayout) -> Canvas:
    """Draw the pixel as a cell of ``layout``, its south-west corner at the origin."""
    canvas, half = Canvas(layout, made.name, made.process), made.geometry.pitch_um / 2
    for axis in (None, half):
        canvas.mirrored(axis)
        _diode(canvas, made)
        _transistors(canvas, made)
    canvas.mirrored(None)
    _lines(canvas, made)
    _ground(canvas, made)
    for metal, corners in grating_polygons(made):
        canvas.polygon(made.process.metals[metal].gds, corners)
    pitch = made.geometry.pitch_um
    canvas.box(made.process.outline, 0, 0, pitch, pitch)
    return canvas


def grating_polygons(made: PixelLayout) -> Iterator[tuple[int, list[tuple[int, int]]]]:
    """(metal, corners in steps of the grid) of every line of both halves' gratings."""
    g, grid = made.geometry, made.process.grid_um
    half = g.pitch_um / 2
    for side, diode in enumerate(made.diodes):
        left, right = side * half + WINDOW_BESIDE, (side + 1) * half - WINDOW_BESIDE
        edges = (left, WINDOW_BELOW, right, g.pitch_um - WINDOW_ABOVE)
        west, south, east, north = (round(edge / grid) for edge in edges)
        shifts = 0.0, g.shift + QUADRATURE[diode]
        for name, of, shift in zip((g.diffraction, g.analyzer), made.gratings(), shifts, strict=True):
            for corners in polygons(of, (west, south, east, north), shift):
                yield made.process.level(name or ""), corners


def _diode(canvas: Canvas, made: PixelLayout) -> None:
    """The western well, and its tap."""
    p, (width, height) = made.process, made.well_um
    canvas.box(p.well, BESIDE, STRIP, BESIDE + width, STRIP + height)
    _tap(canvas, p.nplus, _contacts(made)[0], TAP_Y)


def _tap(canvas: Canvas, implant: tuple[int, int], x: float, y: float) -> None:
    left, bottom, right, top = x - TAP / 2, y - TAP_TALL / 2, x + TAP / 2, y + TAP_TALL / 2
    canvas.box(canvas.process.tap, left, bottom, right, top)
    canvas.box(implant, left - IMPLANT, bottom - IMPLANT, right + IMPLANT, top + IMPLANT)
    canvas.contact(x, y)


def _contacts(made: PixelLayout) -> tuple[float, float, float]:
    """Middles of the contacts to the diode's node, the supply and the column, along x."""
    left, right, _ = DIFFUSION
    return left + 0.145, left + 0.535 + made.l_um, right - 0.175


def _transistors(canvas: Canvas, made: PixelLayout) -> None:
    """From the west: the diode's node, reset, the supply, follower, select, the column."""
    p, (left, right, bottom) = made.process, DIFFUSION
    top = bottom + made.w_um
    middle = bottom + 0.5
    canvas.box(p.active, left, bottom, right, top)
    canvas.box(p.nplus, left - IMPLANT, bottom - IMPLANT, right + IMPLANT, top + IMPLANT)
    for mask, around in p.thick:
        canvas.box(mask, left - around, bottom - around, right + around, top + around)
    node, supply, column = _contacts(made)
    gates = made.gates_um
    reset, follower, select = (gate + made.l_um / 2 for gate in gates)
    for gate, middle_x, (low, high) in zip(
        gates,
        (reset, follower, select),
        ((RESET_Y - END, top + 0.13), (bottom - 0.13, READ_Y + END), (bottom - 0.13, READ_Y + END)),
        strict=True,
    ):
        canvas.box(p.poly, gate, low, gate + made.l_um, high)
        canvas.poly_contact(middle_x, RESET_Y if low < bottom - 0.2 else READ_Y, upright=gate != gates[1])
    canvas.stack(reset, RESET_Y, 0, ROWS_ON)
    canvas.stack(select, READ_Y, 0, ROWS_ON)
    for x in (node, supply, column):
        canvas.contact(x, middle)
    # the diode's node: from the contact up past the follower's gate to the well's tap
    canvas.wire(0, node - 0.085, middle, node + 0.085, TAP_Y)
    canvas.wire(0, node - 0.085, READ_Y - 0.085, follower, READ_Y + 0.085)
    # the supply and the column: on the rows' metal to their lines between the halves
    half = made.geometry.pitch_um / 2
    for x, y, end in ((supply, bottom + 0.25, half), (column, bottom + 0.75, half - COLUMN)):
        canvas.wire(0, x - 0.085, min(y, middle) - 0.085, x + 0.085, max(y, middle) + 0.085)
        canvas.stack(x, y, 0, ROWS_ON)
        canvas.wire(ROWS_ON, x, y - LINE / 2, end, y + LINE / 2)
        canvas.stack(end, y, ROWS_ON, COLUMNS)


def _lines(canvas: Canvas, made: PixelLayout) -> None:
    """Rows, columns and the supply, from edge to edge."""
    pitch = made.geometry.pitch_um
    half = pitch / 2
    for name, y in (("pixel_reset", RESET_Y), ("read", READ_Y)):
        canvas.wire(ROWS_ON, 0, y - LINE / 2, pitch, y + LINE / 2)
        canvas.label(ROWS_ON, name, LINE / 2, y)
    for name, x in (("column_a", half - COLUMN), ("vdda", half), ("column_b", half + COLUMN)):
        canvas.wire(COLUMNS, x - LINE / 2, 0, x + LINE / 2, pitch)
        canvas.label(COLUMNS, name, x, LINE / 2)
    canvas.wire(PLATES, 0, PLATE[0], pitch, PLATE[1])
    canvas.stack(half, DIFFUSION[2] + 0.8, COLUMNS, PLATES)


def _ground(canvas: Canvas, made: PixelLayout) -> None:
    """The light shield, which is the ground's mesh, and the tap of the substrate below it."""
    pitch, upper = made.geometry.pitch_um, made.process.metals[UPPER].gds
    for left, right in ((0, BAR), (pitch / 2 - BAR, pitch / 2 + BAR), (pitch - BAR, pitch)):
        canvas.box(upper, left, 0, right, pitch)
    canvas.box(upper, 0, SHIELD[0], pitch, SHIELD[1])
    canvas.label(UPPER, "vssa", LINE, LINE / 2)
    x = 0.25
    _tap(canvas, made.process.pplus, x, TAP_Y)
    canvas.stack(x, TAP_Y, 0, UPPER)
    canvas.wire(PLATES, 0, TAP_Y - 0.25, 0.5, TAP_Y + 0.25)  # a via's pad is below the least area
