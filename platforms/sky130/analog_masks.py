"""SKY130 for drawn analog circuits.

The capacitor is cap_mim_m3_1: capm over met3, contacted by via3 from met4; 2 fF/um2 and 0.19 fF/um of its edge
(SkyWater's card, typical), as in `analog.unit_cells`.

PDKMaster's deck forbids low-threshold implants over n+ and p+, where its own deck of LVS and SkyWater's layouts have
these transistors' gates; and it takes a via on an upper plate for one to the lower plate, too.
"""

from pathlib import Path

from talbot.platforms.analog import AnalogMasks

from .analog import ROLES
from .layers import LVTN
from .pixel import PROCESS

MASKS = AnalogMasks(
    base=PROCESS,
    low_threshold=LVTN,
    low=frozenset({"n_lvt", "p_lvt"}),
    models={role: f"{model}__model" for role, model in ROLES.items()},
    mim=(89, 44),
    mim_metal=3,
    mim_area=2.0,
    mim_edge=0.19,
    deck_mim="sky130_fd_pr__cap_mim_m3_1",
    rules=Path(__file__).with_name("analog.drc"),
    thick=Path(__file__).with_name("thick.drc"),
    lvs=Path(__file__).with_name("analog.lvs"),
    contradicted=("(nsdm&lvtn) empty", "(psdm&lvtn) empty"),
    connections={"connect(m3, via3)": "via3_beside = via3 - capm\nconnect(m3, via3_beside)\nconnect(via3_beside, m4)"},
)
