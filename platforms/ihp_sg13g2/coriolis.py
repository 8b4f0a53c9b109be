"""SG13G2 for the embedded backend: what Coriolis, KLayout and the steps of flow.layout must know of it."""

from platforms.coriolis import Cut, Embedded, Fill, Wire
from platforms.patience import patience


def library():
    """The PDKMaster library of the cells, all layouts made."""
    from c4m.flexcell import factory
    from c4m.pdk.ihpsg13g2 import stdcell
    from c4m.pdk.ihpsg13g2.pdkmaster import cktfab, layoutfab, tech
    from pdkmaster.design.library import RoutingGaugeLibrary

    # The wheel's rows (5.31 um) with a site that divides them: its own, 0.80 um, does not, and wells overlap
    canvas = factory.StdCellCanvas(
        tech=tech,
        nmos=tech.primitives["sg13g2_lv_nmos"],
        nmos_min_w=0.78,
        pmos=tech.primitives["sg13g2_lv_pmos"],
        pmos_min_w=0.78,
        cell_height=PROCESS.row_um,
        cell_horplacement_grid=PROCESS.site_um,
        m1_vssrail_width=1.12,
        m1_vddrail_width=1.12,
        well_edge_height=2.66,
    )
    made = RoutingGaugeLibrary(name="StdCellLib", tech=tech, routinggauge=canvas.routinggauge)
    with patience():
        stdcell._fab.StdCellFactory(lib=made, cktfab=cktfab, layoutfab=layoutfab, canvas=canvas).add_default()
        for cell in made.cells:
            cell.layout
    return made


# With a diffusion of 0.16 um2 on a net, 3200 and 20,000 an um2 more; none here is smaller. IHP's limit is that of all
# layers together, the step's of each
_DIFFUSION = (3200, 20000)
PROCESS = Embedded(
    name="ihp-sg13g2",
    package="c4m.pdk.ihpsg13g2",
    wheel="c4m-pdk-ihpsg13g2",
    row_um=5.31,
    site_um=0.885,
    grid_um=0.005,
    supply_v=1.2,
    fill_cells=("tie", "decap_w0"),
    # capacitance to the substrate: ihp-sg13g2_tech.pb.json of klayout-pex 0.6.12; resistance, thickness, antenna ratios
    # and densities: IHP-Open-PDK's sg13g2_tech.lef
    wires=(
        Wire("Metal1", 8, 0, 35.02, 39.59, 0.135, 0.40, 200, _DIFFUSION),
        Wire("Metal2", 10, 0, 18.18, 34.80, 0.103, 0.45, 200, _DIFFUSION),
        Wire("Metal3", 30, 0, 11.99, 31.35, 0.103, 0.45, 200, _DIFFUSION),
        Wire("Metal4", 50, 0, 8.95, 29.08, 0.103, 0.45, 200, _DIFFUSION),
        Wire("Metal5", 67, 0, 7.14, 27.53, 0.103, 0.45, 200, _DIFFUSION),
    ),
    cuts=tuple(Cut(f"Via{k}", layer, 0, 0.19, 0.29, 0.05, 20.0) for k, layer in enumerate((19, 29, 49, 66), 1)),
    # below 1 um: along more than that, wires wider than 0.39 um would have to be farther from the router's
    strap_um=0.95,
    rail_um=2.24,
    rail_overlap_um=0.9,
    pin_pitch_um={"horizontal": 0.5, "vertical": 0.5},
    label_datatype=25,
    pin_datatype=2,
    blockage_layer=100,
    poly=(5, 0),
    active=(1, 0),
    contact=(6, 0),
    # 35 to 60 % in windows of 200 um; IHP fills on its side, too
    fill=Fill(
        sides_um=(2.0, 1.0, 0.5), space_um=0.42, clearance_um=0.6, density=0.36, density_most=0.6, window_um=200.0
    ),
    antenna_walls=False,
)
