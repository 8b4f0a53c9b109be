"""What of a sensor a layout varies: the die, the chip and each block follow it; the wrappers have fixed sizes."""

from dataclasses import replace

from talbot.base.sensor import Varied
from talbot.pixels.drawn import DRAWN_BLOCKS
from talbot.rtl.sensor_options import FIELDS

CHIP, SENSOR, WRAPPERS = "asp_chip", "asp_sensor", "tt_"
SIZES = "tile", "array.rows", "array.cols", "chip"
CLOCK = "chip.f_clk"
_ARRAY = "array.rows", "array.cols", "chip.lanes", "tile.rows", "tile.cols"
_PHASE = "chip.divider", "chip.n_frac", "chip.cordic_iterations"
# Fields that set the size of a block, by design; none of the other blocks
SIZED = {
    CHIP: tuple(FIELDS.values()),
    "readout_seq": (*_ARRAY, "tile.order"),
    "adc_bank": ("chip.lanes",),
    "quad_divider": ("chip.n_frac",),
    "quad_divider_radix2": ("chip.n_frac",),
    "quad_divider_pipelined": ("chip.n_frac",),
    "cordic": ("chip.n_frac", "chip.cordic_iterations"),
    "phase_path": ("chip.lanes", *_PHASE),
    "run_length": _ARRAY,
    "reg_file": (*_ARRAY, "chip.divider"),
}
_FIXED = Varied(fixed=dict.fromkeys(SIZES, "this design has the sizes of the standard sensor"))
_PHASE_PATH = tuple(name for name in SIZED[CHIP] if name.startswith("chip.") and name != "chip.lanes")
_DIE = replace(DRAWN_BLOCKS, used=(*DRAWN_BLOCKS.used, "tile", *_PHASE_PATH))


def varied(design: str) -> Varied:
    """Return what the layout of ``design`` varies; nothing of wrappers."""
    if design == SENSOR:
        return _DIE
    return _FIXED if design.startswith(WRAPPERS) else Varied(used=(*SIZED.get(design, ()), CLOCK))
