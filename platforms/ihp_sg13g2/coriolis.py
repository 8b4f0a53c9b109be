"""SG13G2 for the layout flow: Coriolis, KLayout and the steps of flow.layout. Densities: sg13g2_tech.lef."""

from typing import Any

from talbot.platforms.coriolis import CoriolisPlatform, Fill
from talbot.platforms.patience import imported, patience

from . import layers, wires


def library() -> Any:
    """The PDKMaster library of the cells, all layouts made."""
    from c4m.flexcell import factory
    from pdkmaster.design.library import RoutingGaugeLibrary

    stdcell, process = imported("c4m.pdk.ihpsg13g2.stdcell"), imported("c4m.pdk.ihpsg13g2.pdkmaster")
    # The wheel's rows (5.31 um) with a site that divides them: its own, 0.80 um, does not, and wells overlap
    primitives: Any = process.tech.primitives
    canvas = factory.StdCellCanvas(
        tech=process.tech,
        nmos=primitives["sg13g2_lv_nmos"],
        nmos_min_w=0.78,
        pmos=primitives["sg13g2_lv_pmos"],
        pmos_min_w=0.78,
        cell_height=PLATFORM.row_um,
        cell_horplacement_grid=PLATFORM.site_um,
        m1_vssrail_width=1.12,
        m1_vddrail_width=1.12,
        well_edge_height=2.66,
    )
    made = RoutingGaugeLibrary(name="StdCellLib", tech=process.tech, routinggauge=canvas.routinggauge)
    with patience():
        stdcell._fab.StdCellFactory(
            lib=made, cktfab=process.cktfab, layoutfab=process.layoutfab, canvas=canvas
        ).add_default()
        for cell in made.cells:
            _ = cell.layout
    return made


PLATFORM = CoriolisPlatform(
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
    route_step_um=(0.25, 0.25),
    label_datatype=layers.LABEL,
    pin_datatype=layers.PIN,
    outline=layers.PRBOUNDARY,
    blockage_layer=100,
    poly=layers.POLY.gds,
    active=layers.ACTIVE,
    contact=layers.CONTACT.gds,
    # 35 to 60 % in windows of 200 um; IHP fills on its side, too
    fill=Fill(
        sides_um=(2.0, 1.0, 0.5), space_um=0.42, clearance_um=0.6, density=0.36, density_most=0.6, window_um=200.0
    ),
    wires=wires.WIRES,
    antenna_walls=False,
)
