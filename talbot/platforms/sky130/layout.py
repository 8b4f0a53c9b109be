"""SKY130 for the layout flow: KLayout and the steps of flow.layout; its cells are those of cells.compact."""

from pathlib import Path

from talbot.platforms.layout import Dummies, Fill, LayoutPlatform
from talbot.platforms.sky130 import layers, wires
from talbot.platforms.sky130.tinytapeout import FRAMES

PLATFORM = LayoutPlatform(
    name="sky130",
    package="c4m.pdk.sky130",
    wheel="c4m-pdk-sky130",
    row_um=3.12,
    site_um=0.52,
    grid_um=0.005,
    supply_v=1.8,
    fill_cells=("tie", "tie_w2", "tie_w4", "tie_w8"),
    metals=layers.METALS[:5],
    vias=layers.VIAS[:4],
    strap_um=1.2,
    rail=1,
    rail_um=0.30,
    rail_overlap_um=0.38,
    pin_pitch_um={"horizontal": 0.52, "vertical": 0.52},
    label_datatype=layers.LABEL,
    pin_datatype=layers.PIN,
    outline=layers.PRBOUNDARY,
    blockage_layer=100,
    poly=layers.POLY.gds,
    active=layers.DIFF,
    tap=layers.TAP,
    contact=layers.LICON.gds,
    # 35 to 60 % of a layer, as open_pdks' check_density.py asks. Widths, areas and
    # clearances keep the rules of m1 to m4; diffusion keeps 0.27 um to its neighbours, its implant 0.125 um around it
    fill=Fill(
        width_um=0.3,
        area_um2=0.24,
        side_um=1.4,  # metal from 1.5 um on keeps more distance
        clearances_um={"m1": (0.4, 0.2), "m2": (0.4, 0.2), "m3": (0.6, 0.3), "m4": (0.6, 0.3)},
        density=0.37,
        density_least=0.35,
        density_most=0.6,
        window_um=700.0,
    ),
    dummies=Dummies(
        implants=(layers.NSDM, layers.PSDM),
        taps=layers.TAP,
        insets_um={layers.DIFF: (0.265, 0.125), layers.LI1.gds: (0.265, 0.04)},
    ),
    wires=wires.WIRES,
    masks=Path(__file__).with_name("masks.drc"),
    lvs=Path(__file__).with_name("thresholds.lvs"),
    # implants of thresholds over n+ and p+, where PDKMaster's own deck of LVS has these transistors' gates
    contradicted=("(nsdm&lvtn) empty", "(psdm&lvtn) empty", "(nsdm&hvtp) empty", "(psdm&hvtp) empty"),
    corners=("tt_025C_1v80", "ss_100C_1v60", "ff_n40C_1v95"),
    frames=FRAMES,
)
