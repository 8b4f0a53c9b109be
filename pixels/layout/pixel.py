"""One pixel drawn: two photodiodes under the gratings of its type, and the transistors that read them.

    +------------------+------------------+   One grating is over both halves: light that walks from one into the
    |b    g r a t      | i n g           b|   other meets there what an endless grating would give. Each half has an
    |a  analyzer  fr-  | -ame  analyzer  a|   n well as photodiode under an analyzer, which is half a period farther
    |r  well a         |       well b    r|   on in the other half. A frame on the rows' metal passes to a well only
    +------------------+------------------+   what comes through its analyzer; bars on the upper grating's metal lie
    | reset follower select   (mirrored)  |   between pixels, the supply's plate over the transistors. Columns and
    +-------------------------------------+   supply run up between the halves, rows across the strip of transistors.

The n well, and not n+ in the substrate: it has a fifteenth of the capacitance of an area and half of that of the whole
diode, and its junction is deep where green and red light are absorbed (silicon: 1.1 um at 550 nm).
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from talbot.base.gds import db
from talbot.models.parameters import ParameterError, PixelType, check_real
from talbot.pixels.drawn import PIXEL_PITCHES_UM
from talbot.pixels.layout.canvas import Canvas
from talbot.pixels.layout.circuit import Circuit, circuit
from talbot.pixels.layout.gratings import Lines, Point, lines, octilinear, polygons
from talbot.pixels.optics.fit import Fit
from talbot.pixels.optics.geometry import QUADRATURE, PixelGeometry
from talbot.pixels.tabled import rows
from talbot.platforms.optics import Metal
from talbot.platforms.pixel import PixelProcess, pixel_process

UPPER, COLUMNS, PLATES, ROWS_ON = 4, 2, 3, 1  # metals by their place in the process's table
# um. Of the wells: half of the space between two, the strip of transistors below, the space to the next pixel's strip
BESIDE, STRIP, ABOVE = 0.65, 2.95, 0.05
BAR, SHIELD = 0.45, (0.2, 1.3)  # least of half a bar's width; bottom and top of what joins the bars
# Left and bottom in the pixel's western half; right and top from the pixel's middle and from its northern edge
GRATING = 1.7, 0.2  # bottom and top of the upper grating
OPENING = 0.7, 0.73, 3.1, 0.25  # of the frame: left, right, bottom, top
REACH = 0.6, 0.65, 3.0, 0.15  # of analyzers on the frame's metal, whose lines end in it
BELOW = 0.6, 0.74, 2.8, 0.05  # of analyzers on the columns' metal, over the frame
FRAME = 2.8  # bottom of the frame
BESIDE_WIDE = {UPPER: 0.4, ROWS_ON: 0.28}  # space to metal wider than 1.5 um
PLATE = 0.45, 2.70  # bottom and top of the supply's plate
RESET_Y, READ_Y, LINE = 0.5, 2.38, 0.2  # the rows' lines: middles and width
COLUMN = 0.5  # of the columns' lines from the pixel's middle
DIFFUSION = 0.90, 3.80, 0.95  # left, right and bottom of the transistors
IMPLANT, TAP, TAP_TALL = 0.125, 0.36, 0.42  # around diffusion; a tap's width and height
TAP_Y = 3.40
END = 0.165  # of poly beyond the middle of a contact


@dataclass(frozen=True)
class PixelLayout:
    """The input of a pixel's drawing. Raises ParameterError for a pixel that cannot be drawn.

    geometry: an amplitude pixel.
    kind: the type.
    diodes: rows of `Response` for the two diodes, 0..3 quarter periods (`talbot.pixels.tabled.rows`).
    w_um, l_um: of the transistors.
    octilinear: whether lines at other angles than multiples of 45 degrees are steps of these, as some shuttles ask.
    """

    geometry: PixelGeometry
    kind: PixelType
    diodes: tuple[int, int]
    w_um: float = field(default=1.0, metadata={"unit": "um"})
    l_um: float = field(default=0.5, metadata={"unit": "um"})
    octilinear: bool = False

    def __post_init__(self) -> None:
        process, g = self.process, self.geometry
        if g.kind != "amplitude":
            raise ParameterError(f"kind = {g.kind!r}: must be amplitude for a drawn pixel")
        check_real("pitch_um", g.pitch_um, *PIXEL_PITCHES_UM)
        steps = g.pitch_um / (2 * process.grid_um)  # half a pixel is on the grid
        if abs(steps - round(steps)) > 1e-6:
            raise ParameterError(f"pitch_um = {g.pitch_um}: must be a multiple of {2 * process.grid_um:g}")
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
    def axis(self) -> int | None:
        """The axis of modulation: 0 for vertical lines, 1 for horizontal ones, None for oblique ones."""
        return next((axis for axis, of in enumerate((np.sin, np.cos)) if abs(of(self.kind.gamma)) < 1e-9), None)

    @property
    def well_um(self) -> tuple[float, float]:
        """Width and height of a diode."""
        pitch = self.geometry.pitch_um
        return pitch / 2 - 2 * BESIDE, pitch - STRIP - ABOVE

    @property
    def grating_um(self) -> tuple[float, float]:
        """Bottom and top of the upper grating."""
        return GRATING[0], round(self.geometry.pitch_um - GRATING[1], 6)

    def within(self, box: tuple[float, float, float, float]) -> tuple[float, float, float, float]:
        """Left, right, bottom, top of OPENING, REACH or BELOW in the western half, um."""
        left, right, bottom, top = box
        pitch = self.geometry.pitch_um
        return left, round(pitch / 2 - right, 6), bottom, round(pitch - top, 6)

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
        """Return the upper grating and the analyzer on the manufacturing grid, of one pitch. Raises ParameterError.

        The sensor's y runs from row to row, down; the layout's up: gamma changes its sign.
        """
        g, grid = self.geometry, self.process.grid_um
        stack, normal = g.stack, -self.kind.gamma
        upper, lower = stack.metal("diffraction", g.diffraction), stack.metal("analyzer", g.analyzer or "")

        def fitted(metal: Metal, fill: float) -> Lines:
            return lines(normal, g.period_um / grid, fill, metal.width_um / grid, metal.space_um / grid)

        fits = fitted(upper, g.fill), fitted(lower, g.analyzer_fill)
        pitch = max(of.pitch for of in fits)
        return replace(fits[0], pitch=pitch), replace(fits[1], pitch=pitch)

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


def pixel_layout(geometry: PixelGeometry, kind: PixelType, fit: Fit) -> PixelLayout:
    """Return a type on its gratings. fit: Eq. 3.1 fitted to them, which says where its analyzers are."""
    return PixelLayout(geometry, kind, rows(kind.alpha, fit))


def draw(layout: "db.Layout", pixel: PixelLayout) -> Canvas:
    """Draw the pixel as a cell of ``layout``, its south-west corner at the origin."""
    canvas, half = Canvas(layout, pixel.name, pixel.process), pixel.geometry.pitch_um / 2
    for axis in (None, half):
        canvas.mirrored(axis)
        _diode(canvas, pixel)
        _transistors(canvas, pixel)
    canvas.mirrored(None)
    _lines(canvas, pixel)
    _ground(canvas, pixel)
    for metal, corners in grating_polygons(pixel):
        canvas.polygon(pixel.process.metals[metal].gds, corners)
    pitch = pixel.geometry.pitch_um
    canvas.box(pixel.process.outline, 0, 0, pitch, pitch)
    return canvas


def draw_reference(layout: "db.Layout", pixel: PixelLayout, covered: bool) -> Canvas:
    """Draw a pixel without gratings, named plain or covered; its circuit and frame are those of ``pixel``.

    covered: under the upper grating's metal, and under what is an analyzer in other pixels.
    """
    process, pitch = pixel.process, pixel.geometry.pitch_um
    canvas = Canvas(layout, "pixel_covered" if covered else "pixel_plain", process)
    for axis in (None, pitch / 2):
        canvas.mirrored(axis)
        _diode(canvas, pixel)
        _transistors(canvas, pixel)
        if covered:
            left, right, bottom, top = pixel.within(OPENING)
            least = BESIDE_WIDE[ROWS_ON]
            canvas.wire(ROWS_ON, left + least, bottom + least, right - least, top - least)
    canvas.mirrored(None)
    _lines(canvas, pixel)
    _ground(canvas, pixel)
    if covered:
        low, high = pixel.grating_um
        canvas.wire(UPPER, 0, low, pitch, high)  # wide: as far from the shields as gratings are
    canvas.box(process.outline, 0, 0, pitch, pitch)
    return canvas


def grating_polygons(pixel: PixelLayout) -> Iterator[tuple[int, list[Point]]]:
    """(metal, corners in steps of the grid) of every line: of the upper grating, then of both halves' analyzers."""
    for level, of, polygons_of in _gratings(pixel):
        for corners in polygons_of:
            if drawn := octilinear(corners, of) if pixel.octilinear else corners:
                yield level, drawn


def openings(pixel: PixelLayout) -> Iterator[tuple[int, tuple[float, float, float, float]]]:
    """(metal, box in um) of every opening for light: between the bars, and in the frame over each well.

    Vertical and horizontal lines continue in the adjacent edges: the space to these is that of two lines, or the least
    space to wide metal.
    """
    grid, pitch, axis = pixel.process.grid_um, pixel.geometry.pitch_um, pixel.axis
    left, right, bottom, top = pixel.within(OPENING)
    nominal = [(BAR, 0.0, pitch - BAR, pitch)]
    nominal += [(x, bottom, y, top) for x, y in ((left, right), (pitch - right, pitch - left))]
    for (level, of, polygons_of), box in zip(_gratings(pixel), nominal, strict=True):
        if level == UPPER and axis == 0 or level == ROWS_ON and axis is not None:
            places = [corner[axis] for corners in polygons_of for corner in corners]
            space = max(of.pitch - of.width, round(BESIDE_WIDE[level] / grid))  # of a direction of length 1
            aligned = list(box)
            aligned[axis], aligned[axis + 2] = grid * (min(places) - space), grid * (max(places) + space)
            box = (aligned[0], aligned[1], aligned[2], aligned[3])
        yield (UPPER if level == UPPER else ROWS_ON), box


def _gratings(pixel: PixelLayout) -> Iterator[tuple[int, Lines, list[list[Point]]]]:
    """(metal, grating, its lines) of the upper grating and of the analyzer of each half, of one origin."""
    g, grid = pixel.geometry, pixel.process.grid_um
    pitch, (upper, lower) = g.pitch_um, pixel.gratings()
    low, high = pixel.grating_um
    origin = round(pitch / 2 / grid), round((low + high) / 2 / grid)

    def within(of: Lines, box: tuple[float, float, float, float], shift: float) -> list[list[Point]]:
        west, south, east, north = (round(edge / grid) for edge in box)
        return [*polygons(of, (west, south, east, north), shift, origin)]

    lines_apart = grid * (upper.pitch - upper.width) if pixel.axis == 0 else 0.0
    beside = BAR + max(lines_apart, BESIDE_WIDE[UPPER])
    yield UPPER, upper, within(upper, (beside, low, pitch - beside, high), 0.0)
    level, least = pixel.process.level(g.analyzer or ""), BESIDE_WIDE[ROWS_ON]
    if level != ROWS_ON:
        left, right, bottom, top = pixel.within(BELOW)
    elif pixel.axis is not None:
        space = max(grid * (lower.pitch - lower.width), least)
        x, y = (space, 0.0) if pixel.axis == 0 else (0.0, space)
        west, east, south, north = pixel.within(REACH)
        left, right, bottom, top = west + x, east - x, south + y, north - y
    else:
        west, east, south, north = pixel.within(OPENING)
        left, right, bottom, top = west + least, east - least, south + least, north - least
    for diode, (west, east) in zip(pixel.diodes, ((left, right), (pitch - right, pitch - left)), strict=True):
        yield level, lower, within(lower, (west, bottom, east, top), g.shift + QUADRATURE[diode])


def _diode(canvas: Canvas, pixel: PixelLayout) -> None:
    """The western well, and its tap."""
    p, (width, height) = pixel.process, pixel.well_um
    canvas.box(p.well, BESIDE, STRIP, BESIDE + width, STRIP + height)
    _tap(canvas, p.nplus, _contacts(pixel)[0], TAP_Y)


def _tap(canvas: Canvas, implant: tuple[int, int], x: float, y: float) -> None:
    left, bottom, right, top = x - TAP / 2, y - TAP_TALL / 2, x + TAP / 2, y + TAP_TALL / 2
    canvas.box(canvas.process.tap, left, bottom, right, top)
    canvas.box(implant, left - IMPLANT, bottom - IMPLANT, right + IMPLANT, top + IMPLANT)
    canvas.contact(x, y)


def _contacts(pixel: PixelLayout) -> tuple[float, float, float]:
    """Middles of the contacts to the diode's node, the supply and the column, along x."""
    left, right, _ = DIFFUSION
    return left + 0.145, left + 0.535 + pixel.l_um, right - 0.175


def _transistors(canvas: Canvas, pixel: PixelLayout) -> None:
    """Draw, from the west: the diode's node, reset, supply, follower, select, column."""
    p, (left, right, bottom) = pixel.process, DIFFUSION
    top = bottom + pixel.w_um
    middle = bottom + 0.5
    canvas.box(p.active, left, bottom, right, top)
    canvas.box(p.nplus, left - IMPLANT, bottom - IMPLANT, right + IMPLANT, top + IMPLANT)
    for mask, around in p.thick:
        canvas.box(mask, left - around, bottom - around, right + around, top + around)
    node, supply, column = _contacts(pixel)
    gates = pixel.gates_um
    reset, follower, select = (gate + pixel.l_um / 2 for gate in gates)
    for gate, middle_x, (low, high) in zip(
        gates,
        (reset, follower, select),
        ((RESET_Y - END, top + 0.13), (bottom - 0.13, READ_Y + END), (bottom - 0.13, READ_Y + END)),
        strict=True,
    ):
        canvas.box(p.poly, gate, low, gate + pixel.l_um, high)
        canvas.poly_contact(middle_x, RESET_Y if low < bottom - 0.2 else READ_Y, upright=gate != gates[1])
    canvas.stack(reset, RESET_Y, 0, ROWS_ON)
    canvas.stack(select, READ_Y, 0, ROWS_ON)
    for x in (node, supply, column):
        canvas.contact(x, middle)
    # the diode's node: from the contact up past the follower's gate to the well's tap
    canvas.wire(0, node - 0.085, middle, node + 0.085, TAP_Y)
    canvas.wire(0, node - 0.085, READ_Y - 0.085, follower, READ_Y + 0.085)
    # the supply and the column: on the rows' metal to their lines between the halves
    half = pixel.geometry.pitch_um / 2
    for x, y, end in ((supply, bottom + 0.25, half), (column, bottom + 0.75, half - COLUMN)):
        canvas.wire(0, x - 0.085, min(y, middle) - 0.085, x + 0.085, max(y, middle) + 0.085)
        canvas.stack(x, y, 0, ROWS_ON)
        canvas.wire(ROWS_ON, x, y - LINE / 2, end, y + LINE / 2)
        canvas.stack(end, y, ROWS_ON, COLUMNS)


def _lines(canvas: Canvas, pixel: PixelLayout) -> None:
    """Rows, columns and the supply, from edge to edge."""
    pitch = pixel.geometry.pitch_um
    half = pitch / 2
    for name, y in (("pixel_reset", RESET_Y), ("read", READ_Y)):
        canvas.wire(ROWS_ON, 0, y - LINE / 2, pitch, y + LINE / 2)
        canvas.label(ROWS_ON, name, LINE / 2, y)
    for name, x in (("column_a", half - COLUMN), ("vdda", half), ("column_b", half + COLUMN)):
        canvas.wire(COLUMNS, x - LINE / 2, 0, x + LINE / 2, pitch)
        canvas.label(COLUMNS, name, x, LINE / 2)
    canvas.wire(PLATES, 0, PLATE[0], pitch, PLATE[1])
    canvas.stack(half, DIFFUSION[2] + 0.8, COLUMNS, PLATES)


def _ground(canvas: Canvas, pixel: PixelLayout) -> None:
    """The light shield, which is the ground's mesh, and the tap of the substrate below it."""
    pitch = pixel.geometry.pitch_um
    bars, *frame = (box for _, box in openings(pixel))
    for left, right in ((0, BAR), (pitch - BAR, pitch)):
        canvas.wire(UPPER, left, 0, right, pitch)
    for left, right in ((0, bars[0]), (bars[2], pitch)):
        canvas.wire(UPPER, left, SHIELD[0], right, pixel.grating_um[1])
    canvas.wire(UPPER, 0, SHIELD[0], pitch, SHIELD[1])
    for (left, bottom, right, top), (west, east) in zip(frame, ((0, pitch / 2), (pitch / 2, pitch)), strict=True):
        for box in (
            (west, FRAME, left, pitch),
            (right, FRAME, east, pitch),
            (west, FRAME, east, bottom),
            (west, top, east, pitch),
        ):
            canvas.wire(ROWS_ON, *box)
    canvas.label(UPPER, "vssa", LINE, LINE / 2)
    x = 0.25
    _tap(canvas, pixel.process.pplus, x, TAP_Y)
    canvas.stack(x, TAP_Y, 0, UPPER)
    canvas.wire(PLATES, 0, TAP_Y - 0.25, 0.5, TAP_Y + 0.25)  # a via's pad is below the least area
