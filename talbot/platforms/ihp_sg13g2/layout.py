"""SG13G2 for the layout flow: KLayout and the steps of flow.layout. Densities: sg13g2_tech.lef."""

from talbot.platforms.ihp_sg13g2 import layers, wires
from talbot.platforms.layout import Fill, LayoutPlatform

PLATFORM = LayoutPlatform(
    name="ihp-sg13g2",
    package="c4m.pdk.ihpsg13g2",
    wheel="c4m-pdk-ihpsg13g2",
    row_um=5.31,
    site_um=0.885,
    grid_um=0.005,
    supply_v=1.2,
    fill_cells=("tie", "decap_w0"),
    metals=layers.METALS,
    vias=layers.VIAS,
    # below 1 um: along more than that, metal wider than 0.39 um must keep more distance than the router's
    strap_um=0.95,
    rail_um=2.24,
    rail_overlap_um=0.9,
    pin_pitch_um={"horizontal": 0.5, "vertical": 0.5},
    label_datatype=layers.LABEL,
    pin_datatype=layers.PIN,
    outline=layers.PRBOUNDARY,
    blockage_layer=100,
    poly=layers.POLY.gds,
    active=layers.ACTIVE,
    contact=layers.CONTACT.gds,
    # 35 to 60 % in windows of 200 um; IHP fills on its side, too
    fill=Fill(
        width_um=0.5,
        area_um2=0.25,
        side_um=2.0,
        clearances_um={metal.name: (0.6, 0.42) for metal in layers.METALS},
        density=0.37,
        density_least=0.35,
        density_most=0.6,
        window_um=200.0,
    ),
    wires=wires.WIRES,
    antenna_walls=False,
)
