"""What of a sensor a layout varies: the chip follows it; blocks and the die have the standard sensor's sizes."""

from talbot.base.sensor import Varied
from talbot.pixels.drawn import DRAWN_PITCH
from talbot.rtl.sensor_options import FIELDS

CHIP, SENSOR = "asp_chip", "asp_sensor"
SIZES = "tile", "array.rows", "array.cols", "chip"
VARIED = Varied(used=(*FIELDS.values(), "chip.f_clk"))  # of the chip
_BLOCK = Varied(
    fixed=dict.fromkeys(SIZES, f"DESIGN={CHIP} alone is laid out in other sizes than the standard sensor's")
)
_DIE = Varied(fixed={**_BLOCK.fixed, **DRAWN_PITCH})


def varied(design: str) -> Varied:
    """Return what the layout of ``design`` varies."""
    return {CHIP: VARIED, SENSOR: _DIE}.get(design, _BLOCK)
