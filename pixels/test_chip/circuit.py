"""The test chip as a circuit: pixels, level shifters of the digital pins, columns' switches, followers.

    ui_in[4:0]   -- lift -- read of a row          photodiode - follower - select -- column -- switch -- bus
    ui_in[5]     -- lift -- reset of all rows                                                  |
    uio_in[5:0]  -- lift -- switches of a column   sink, from ibias ---------------------------+-- follower -- ua

Every input selects directly: there is no clock. The pixels have a supply of their pin, below VAPWR by more than a
threshold, so that a reset is complete; VAPWR supplies the level shifters and the followers.
"""

from talbot.pixels.circuits.netlist import Circuit, Instance, Transistor
from talbot.pixels.circuits.row_driver import THICK, lift
from talbot.pixels.drawn import DUMMIES
from talbot.pixels.layout.circuit import SIDES, Diode
from talbot.pixels.test_chip.places import COLS, ROWS

NAME = "tt_um_talbot_pixels"
INPUTS = {f"ui_in[{row}]": f"read[{row}]" for row in range(ROWS)}
INPUTS |= {"ui_in[5]": "pixel_reset"} | {f"uio_in[{col}]": f"column[{col}]" for col in range(COLS)}
VDDA, OUT_B, OUT_A, BIAS = ANALOG = tuple(f"ua[{pin}]" for pin in range(4))  # from the east
OUT = {"a": OUT_A, "b": OUT_B}
GROUND, LOGIC, HIGH = "VGND", "VDPWR", "VAPWR"
# um: a column's switch; the sinks; the followers and what supplies their current
SWITCH, SINK, SINK_LENGTH = 2.0, 4.0, 2.0
FOLLOWER, SOURCE, SOURCE_LENGTH, REFERENCE = 20.0, 16.0, 1.0, 4.0


def lifts() -> Circuit:
    """Return a level shifter for each input. Pins: inputs, their lines, VDPWR VAPWR VGND."""
    supplies = LOGIC, HIGH, GROUND
    parts = tuple(Instance(line, lift(), (pin, line, *supplies)) for pin, line in INPUTS.items())
    return Circuit("lifts", (*INPUTS, *INPUTS.values(), *supplies), instances=parts)


def readout() -> Circuit:
    """Switches of all columns, sinks, followers. Pins: columns, their selects, `ANALOG` without VDDA, VAPWR VGND."""

    def n(name: str, drain: str, gate: str, source: str, w: float, length: float) -> Transistor:
        return Transistor(name, drain, gate, source, GROUND, "n_thick", w, length)

    def p(name: str, drain: str, gate: str, source: str, w: float, length: float) -> Transistor:
        return Transistor(name, drain, gate, source, HIGH, "p_thick", w, length)

    parts = [
        n(f"switch_{side}{col}", f"column_{side}[{col}]", f"column[{col}]", f"bus_{side}", SWITCH, THICK)
        for col in range(COLS)
        for side in SIDES
    ]
    parts += [
        n("input", BIAS, BIAS, GROUND, SINK, SINK_LENGTH),
        n("turn", "high_bias", BIAS, GROUND, SINK, SINK_LENGTH),
        p("reference", "high_bias", "high_bias", HIGH, REFERENCE, SOURCE_LENGTH),
    ]
    for side in SIDES:
        parts += [
            n(f"sink_{side}", f"bus_{side}", BIAS, GROUND, SINK, SINK_LENGTH),
            p(f"source_{side}", OUT[side], "high_bias", HIGH, SOURCE, SOURCE_LENGTH),
            p(f"follower_{side}", GROUND, f"bus_{side}", OUT[side], FOLLOWER, THICK),
        ]
    columns = [f"column_{side}[{col}]" for side in SIDES for col in range(COLS)]
    selects = [f"column[{col}]" for col in range(COLS)]
    return Circuit("readout", (*columns, *selects, *ANALOG[1:], HIGH, GROUND), tuple(parts))


def pixels(pixel: str, ring: Diode, diode: str) -> list[str]:
    """Lines of all pixels, subcircuits ``pixel``, dummies among them, and of the ring of n well around them.

    Dummy rows are held in reset and never read; dummy columns end open.
    """
    lines = []
    for row in range(-DUMMIES, ROWS + DUMMIES):
        across = f"pixel_reset read[{row}]" if 0 <= row < ROWS else f"{VDDA} {GROUND}"
        for col in range(-DUMMIES, COLS + DUMMIES):
            inner = 0 <= col < COLS
            name = f"{row + DUMMIES}_{col + DUMMIES}"
            down = " ".join(f"column_{side}[{col}]" if inner else f"open_{side}_{col + DUMMIES}" for side in SIDES)
            lines.append(f"Xpixel{name} {across} {down} {VDDA} {GROUND} {pixel}")
    lines.append(f"D{ring.name} {GROUND} {ring.node} {diode} A={ring.area_um2:g}P P={ring.perimeter_um:g}U")
    return lines
