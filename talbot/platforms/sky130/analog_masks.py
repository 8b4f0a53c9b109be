"""SKY130 for drawn analog circuits.

The capacitor is cap_mim_m3_1: capm over met3, contacted by via3 from met4; 2 fF/um2 and 0.19 fF/um of its edge
(SkyWater's card, typical), as in `analog.unit_cells`. Fringe capacitors of met1 and met2: the cards of three of
SkyWater's (cap_vpp_11p5x11p7, 08p6x07p8, 04p4x04p6, m1m2_noshield: 74.6, 35.0, 7.81 fF) have 0.72 to 0.83 of what the
rays of signoff/parasitics find in their layouts, of the wheel; of fingers of minimum width and space these find
0.457 fF/um. Their mark is no mask of SkyWater's: its own mark of capacitors, (82, 64), has rules of 1.43 um and more.

PDKMaster's deck takes a via on an upper plate for one to the lower plate, too.
"""

from pathlib import Path

from talbot.platforms.analog import AnalogMasks
from talbot.platforms.sky130.analog import RESISTOR_TYPICAL, ROLES
from talbot.platforms.sky130.layers import LVTN
from talbot.platforms.sky130.pixel import PROCESS

MASKS = AnalogMasks(
    base=PROCESS,
    low_threshold=LVTN,
    low=frozenset({"n_lvt", "p_lvt"}),
    models={role: f"{model}__model" for role, model in ROLES.items()},
    mim=(89, 44),
    mim_metal=3,
    mim_area=2.0,
    mim_edge=0.19,
    fringe=(82, 65),
    fringe_side_um=0.14,
    fringe_um=0.3656,
    fringe_end=0.054,
    fringe_share=0.8,
    deck_mim="sky130_fd_pr__cap_mim_m3_1",
    deck_fringe="fringe",
    resistor=(65, 13),
    sheet_ohm=RESISTOR_TYPICAL,
    deck_resistor="sky130_fd_pr__res_generic_nd",
    rules=Path(__file__).with_name("analog.drc"),
    thick=Path(__file__).with_name("thick.drc"),
    lvs=Path(__file__).with_name("analog.lvs"),
    connections={"connect(m3, via3)": "via3_beside = via3 - capm\nconnect(m3, via3_beside)\nconnect(via3_beside, m4)"},
)
