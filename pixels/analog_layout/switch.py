"""The switch drivers, in one strip: two loops of a gate and its delays, each the image of the other."""

from talbot.pixels.analog_layout.cells import MARGIN, Cell, finish, new_canvas
from talbot.pixels.analog_layout.comparator import devices
from talbot.pixels.analog_layout.row_driver import ROOM, legs
from talbot.pixels.analog_layout.strip import draw_strip
from talbot.pixels.analog_layout.strip_plan import Plan, in_columns
from talbot.pixels.circuits.support import DELAYS, non_overlap
from talbot.platforms.analog import AnalogMasks

LOOP = "nor", *(f"delay{k}" for k in range(DELAYS))
ORDER = *(f"phi1_{name}" for name in reversed(LOOP)), "not", *(f"phi2_{name}" for name in LOOP)


def switch_cell(masks: AnalogMasks) -> Cell:
    """Draw them; pins are on their tracks."""
    circuit, canvas = non_overlap(), new_canvas(masks, "non_overlap")
    d = devices(circuit)
    n, p, right = in_columns([leg for name in ORDER for leg in legs(d, name)], 0.0, ROOM)
    strip = draw_strip(canvas, masks, Plan(n, p, 0.0, right, {}), MARGIN)
    finish(canvas, [strip], circuit.ports[:3])
    return Cell(canvas.layout, canvas.cell, circuit.ports, tuple(d.values()), terminals=tuple(strip.terminals))
