"""SKY130 with the cells of cells.compact: rows and sites of their own, rails on met1, every mask drawn and checked."""

from dataclasses import replace
from pathlib import Path

from . import coriolis

PLATFORM = replace(
    coriolis.PLATFORM,
    name="sky130-compact",
    row_um=3.12,
    site_um=0.52,
    fill_cells=("tie", "tie_w2", "tie_w4", "tie_w8"),
    rail=1,
    rail_um=0.30,
    rail_overlap_um=0.38,
    rails_over_edge=True,
    pin_pitch_um={"horizontal": 0.52, "vertical": 0.52},
    route_step_um=(0.17, 0.195),
    utilization_most=0.64,
    masks=Path(__file__).with_name("masks.drc"),
)
