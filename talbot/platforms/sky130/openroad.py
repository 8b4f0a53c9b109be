"""SKY130 with sky130_fd_sc_hd for OpenROAD.

Files: as open_pdks installs sky130A. Straps, layers of pins, taps and routing layers: what OpenROAD's own test flow
(test/sky130hd) and flow-scripts' platform sky130hd use. Resistance and capacitance of wires and vias: OpenROAD's
test/sky130hd/sky130hd.rc, fitted there to extracted designs (the technology LEF alone gives met2 0.08 fF/um, the fit
0.136). Rules of extraction: in the order of open_pdks' LibreLane configuration; those named `magic` give twice the
capacitance and are not read. End caps and clock buffers: open_pdks' configuration of the library.
"""

from itertools import chain, zip_longest
from pathlib import Path

from talbot.platforms.openroad import WIRES, OpenRoadPlatform
from talbot.platforms.place_and_route import Strap
from talbot.platforms.sky130 import layers
from talbot.platforms.sky130.cells import LIBRARY, SITE

VOLTS = {"ss_100C_1v60": 1.6, "tt_025C_1v80": 1.8, "ff_n40C_1v95": 1.95}
_CELLS = f"sky130A/libs.ref/{LIBRARY}"

PLATFORM = OpenRoadPlatform(
    name="sky130",
    library=LIBRARY,
    orfs_platform="sky130hd",
    pdk="sky130A",
    liberty={corner: f"{_CELLS}/lib/{LIBRARY}__{corner}.lib" for corner in VOLTS},
    volts=VOLTS,
    tech_lef=f"{_CELLS}/techlef/{LIBRARY}__nom.tlef",
    cell_lef=f"{_CELLS}/lef/{LIBRARY}.lef",
    cell_gds=f"{_CELLS}/gds/{LIBRARY}.gds",
    cell_spice=f"{_CELLS}/spice/{LIBRARY}.spice",
    cell_models=(f"{_CELLS}/verilog/primitives.v", f"{_CELLS}/verilog/{LIBRARY}.v"),
    rcx_rules={
        wires: tuple(
            f"sky130A/libs.tech/{folder}/rules.openrcx.sky130A.{wires}.{kind}"
            for kind in ("calibre", "spef_extractor")
            for folder in ("librelane", "openlane")  # renamed in 2025
        )
        for wires in WIRES
    },
    site=SITE.name,
    site_um=SITE.width_um,
    row_um=SITE.height_um,
    supply=("VPWR", ("VPWR", "VPB")),
    ground=("VGND", ("VGND", "VNB")),
    high=f"{LIBRARY}__conb_1/HI",
    low=f"{LIBRARY}__conb_1/LO",
    buffer=(f"{LIBRARY}__buf_2", "A", "X"),
    output_buffer=f"{LIBRARY}__buf_2",  # repair puts none before a port, and a gate alone cannot drive the load outside
    core_space_um=10.0,  # pins and their way in
    diode=f"{LIBRARY}__diode_2",
    tap=f"{LIBRARY}__tapvpwrvgnd_1",
    tap_um=14.0,
    endcap=f"{LIBRARY}__decap_3",
    clock_gate=(f"{LIBRARY}__dlclkp_1", "GATE", "CLK", "GCLK"),
    clock_root=f"{LIBRARY}__clkbuf_16",
    clock_buffers=tuple(f"{LIBRARY}__clkbuf_{size}" for size in (2, 4, 8)),
    straps=(Strap("met1", 0.48), Strap("met4", 1.6, 27.14, 13.57), Strap("met5", 1.6, 27.2, 13.6)),
    pins=("met3", "met2"),
    signal=("met1", "met5"),
    clock=("met3", "met5"),
    kept_free={f"met{k}": 0.3 for k in range(1, 6)},
    layer_rc={
        "li1": (7.176e-2, 1.499e-4),
        "met1": (8.929e-4, 1.72375e-4),
        "met2": (8.929e-4, 1.36233e-4),
        "met3": (1.567e-4, 2.14962e-4),
        "met4": (1.567e-4, 1.48128e-4),
        "met5": (1.781e-5, 1.54087e-4),
    },
    via_rc={"mcon": 9.249146e-3, "via": 4.5e-3, "via2": 3.368786e-3, "via3": 0.376635e-3, "via4": 0.0058e-3},
    signal_rc=("met1", "met2"),
    clock_rc=("met3", "met4"),
    fill=(
        *(f"{LIBRARY}__decap_{width}" for width in (12, 8, 6, 4, 3)),
        *(f"{LIBRARY}__fill_{width}" for width in (2, 1)),
    ),
    # probes have metal on all layers; lpflow cells belong to designs with several supplies
    dont_use=(f"{LIBRARY}__probe*", f"{LIBRARY}__lpflow*"),
    gds={part.lef: part.gds for part in chain(*zip_longest(layers.METALS, layers.VIAS)) if part},
    outline=layers.PRBOUNDARY,
    pin_datatype=layers.PIN,
    label_datatype=layers.LABEL,
    deck_layers=("li", "mcon", "m1", "via", "m2", "via2", "m3", "via3", "m4", "via4", "m5"),
    lvs=Path(__file__).with_name("openroad.lvs"),
)
