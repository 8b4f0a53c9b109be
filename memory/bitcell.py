"""A cell of six transistors under SKY130's plain logic rules, and the strap between groups of cells.

    y, um
    2.93   ------------------   edge; the next row is the mirror image about it
    2.49   p   p                pull-ups, vdd between them
    1.96   x                    contact of the western gates
    1.54       x                contact of the eastern gates
    0.95   n   n                pull-downs, vss between them
    0.22   ==================   word line: poly, and met1 above; strapped between groups of cells
    0.00   bl  br               edge through the bit lines' contacts; the next row is the mirror image about it

Bit lines are on met2; word lines, vss and vdd on met1. The origin is at the middle of the lower edge.
"""

from talbot.base.gds import db
from talbot.pixels.circuits.netlist import Circuit, Transistor
from talbot.pixels.layout.canvas import Canvas
from talbot.platforms.analog import AnalogMasks

# um
PITCH = 1.90  # of columns
HEIGHT = 2.93  # of rows
STRAP = 1.20  # width of a strap
LENGTH = 0.15  # of all gates
ACCESS, DOWN, UP = 0.42, 0.63, 0.42  # widths of the access, pull-down and pull-up transistors
BIT_X = 0.58  # from a cell's middle to its bit lines
BIT_WIDTH = 0.30  # of a bit line
GATE_X = 0.215  # from a cell's middle to its gates
PAD_X = 0.24  # from a cell's middle to the gates' contacts
N, P = (0.63, 1.26), (2.275, 2.695)  # pull-downs and pull-ups
LOW, HIGH = 1.535, 1.955  # contacts of the eastern and of the western gates
WORD = 0.14, 0.29  # word line on poly
WORD_METAL = 0.30, 0.44
GROUND, SUPPLY = (0.60, 1.29), (2.10, HIGH + 0.975)  # rails
WELL = 2.095  # lower edge of the n well
RAIL_X = 0.30  # from a strap's middle to its rails on met2: vss in the west
PORTS = "bl", "br", "wl", "vdd", "vss"


def bit_cell() -> Circuit:
    """The cell's circuit."""
    n, p = "n", "p"
    return Circuit(
        "bit_cell",
        PORTS,
        (
            Transistor("access_l", "bl", "wl", "q", "vss", n, ACCESS, LENGTH),
            Transistor("access_r", "br", "wl", "qn", "vss", n, ACCESS, LENGTH),
            Transistor("down_l", "q", "qn", "vss", "vss", n, DOWN, LENGTH),
            Transistor("down_r", "qn", "q", "vss", "vss", n, DOWN, LENGTH),
            Transistor("up_l", "q", "qn", "vdd", "vdd", p, UP, LENGTH),
            Transistor("up_r", "qn", "q", "vdd", "vdd", p, UP, LENGTH),
        ),
    )


def draw_cell(layout: "db.Layout", masks: AnalogMasks) -> Canvas:
    """Draw the cell ``bit_cell`` without names of nets."""
    canvas, m = Canvas(layout, "bit_cell", masks.base), masks.base
    half, mid_n, mid_p = PITCH / 2, sum(N) / 2, sum(P) / 2
    canvas.box(m.active, -0.79, N[0], 0.79, N[1])
    canvas.box(m.active, -0.725, P[0], 0.725, P[1])
    canvas.box(m.nplus, -half, -0.27, half, N[1] + 0.125)
    canvas.box(m.pplus, -half, P[0] - 0.125, half, HEIGHT)
    canvas.box(m.well, -half, WELL, half, HEIGHT)
    canvas.box(m.poly, -half, WORD[0], half, WORD[1])
    canvas.box(m.contact_poly, -half, LOW - 0.185, half, HIGH + 0.185)
    canvas.wire(1, -half, WORD_METAL[0], half, WORD_METAL[1])
    canvas.wire(1, -half, GROUND[0], half, GROUND[1])
    canvas.wire(1, -half, SUPPLY[0], half, SUPPLY[1])
    for y in (mid_n, mid_p):
        canvas.contact(0, y)
        canvas.square(m.vias[0].gds, 0, y, 0.17)
    for side, pad in ((-1, HIGH), (1, LOW)):
        x = side * BIT_X
        canvas.box(m.active, *_sorted(side * 0.37, side * 0.79, -0.145, N[0]))
        canvas.box(m.poly, *_sorted(side * (GATE_X - 0.075), side * (GATE_X + 0.075), N[0] - 0.13, P[1] + 0.13))
        canvas.box(m.poly, *_sorted(side * (PAD_X - 0.135), side * (PAD_X + 0.135), pad - 0.165, pad + 0.165))
        canvas.square(m.contact, side * PAD_X, pad, 0.17)
        canvas.wire(0, *_sorted(side * (PAD_X - 0.085), side * (PAD_X + 0.085), pad - 0.165, pad + 0.165))
        canvas.wire(0, *_sorted(side * (PAD_X + 0.085), -x, pad - 0.085, pad + 0.085))
        for y in (mid_n, mid_p):
            canvas.contact(x, y)
        canvas.wire(0, x - 0.085, mid_n, x + 0.085, mid_p)
        canvas.contact(x, 0)
        canvas.square(m.vias[0].gds, x, 0, 0.17)
        canvas.wire(1, x - 0.13, -0.16, x + 0.13, 0.16)
        canvas.square(m.vias[1].gds, x, 0, 0.15)
        canvas.wire(2, x - BIT_WIDTH / 2, -0.16, x + BIT_WIDTH / 2, HEIGHT)
    return canvas


def draw_strap(layout: "db.Layout", masks: AnalogMasks) -> Canvas:
    """Draw the cell ``strap``: taps, the word line's contact, rails on met2; as high as a row."""
    canvas, m = Canvas(layout, "strap", masks.base), masks.base
    half, mid_n, word = STRAP / 2, sum(N) / 2, 0.27
    canvas.box(m.poly, -half, WORD[0], half, WORD[1])
    canvas.box(m.poly, -0.165, word - 0.135, 0.165, word + 0.135)
    canvas.contact(0, word, upright=False)
    canvas.box(m.contact_poly, -0.185, -word - 0.185, 0.185, word + 0.185)
    canvas.square(m.vias[0].gds, 0, word, 0.17)
    canvas.wire(1, -0.145, word - 0.115, 0.145, WORD_METAL[1])
    canvas.wire(1, -half, WORD_METAL[0], half, WORD_METAL[1])
    canvas.box(m.well, -half, WELL, half, HEIGHT)
    taps = (mid_n, m.pplus, GROUND, -RAIL_X, mid_n), (HEIGHT, m.nplus, SUPPLY, RAIL_X, sum(P) / 2)
    for y, implant, rail, x, via in taps:
        canvas.square(m.tap, 0, y, 0.41)
        canvas.square(implant, 0, y, 0.66)
        canvas.contact(0, y)
        canvas.square(m.vias[0].gds, 0, y, 0.17)
        canvas.wire(1, -half, rail[0], half, rail[1])
        canvas.square(m.vias[1].gds, x, via, 0.15)
        canvas.wire(2, x - 0.16, 0, x + 0.16, HEIGHT)
    return canvas


def _sorted(a: float, b: float, low: float, high: float) -> tuple[float, float, float, float]:
    """Left, bottom, right, top of a rectangle between x of ``a`` and ``b``."""
    return min(a, b), low, max(a, b), high
