"""SKY130 with sky130_fd_sc_hd for OpenROAD.

Files: as open_pdks installs sky130A. Straps, layers of pins, taps and routing layers: what OpenROAD's own test flow
(test/sky130hd) and flow-scripts' platform sky130hd use.
"""

from itertools import chain, zip_longest

from platforms.openroad import OpenRoadPlatform, Strap

from . import layers
from .cells import LIBRARY, SITE

_CELLS = f"sky130A/libs.ref/{LIBRARY}"

PLATFORM = OpenRoadPlatform(
    name="sky130",
    library=LIBRARY,
    orfs_platform="sky130hd",
    pdk="sky130A",
    liberty={
        corner: f"{_CELLS}/lib/{LIBRARY}__{name}.lib"
        for corner, name in (("slow", "ss_100C_1v60"), ("typical", "tt_025C_1v80"), ("fast", "ff_n40C_1v95"))
    },
    tech_lef=f"{_CELLS}/techlef/{LIBRARY}__nom.tlef",
    cell_lef=f"{_CELLS}/lef/{LIBRARY}.lef",
    cell_gds=f"{_CELLS}/gds/{LIBRARY}.gds",
    cell_models=(f"{_CELLS}/verilog/primitives.v", f"{_CELLS}/verilog/{LIBRARY}.v"),
    rcx_rules=tuple(
        f"sky130A/libs.tech/{folder}/rules.openrcx.sky130A.nom.magic" for folder in ("librelane", "openlane")
    ),  # renamed in 2025
    site=SITE.name,
    site_um=SITE.width_um,
    row_um=SITE.height_um,
    supply=("VPWR", ("VPWR", "VPB")),
    ground=("VGND", ("VGND", "VNB")),
    high=f"{LIBRARY}__conb_1/HI",
    low=f"{LIBRARY}__conb_1/LO",
    diode=f"{LIBRARY}__diode_2",
    tap=f"{LIBRARY}__tapvpwrvgnd_1",
    tap_um=14.0,
    clock_buffer=f"{LIBRARY}__clkbuf_4",
    straps=(Strap("met1", 0.48), Strap("met4", 1.6, 27.14, 13.57), Strap("met5", 1.6, 27.2, 13.6)),
    pins=("met3", "met2"),
    signal=("met1", "met5"),
    clock=("met3", "met5"),
    signal_rc="met2",
    clock_rc="met5",
    fill=tuple(f"{LIBRARY}__fill_{width}" for width in (1, 2, 4, 8)),
    # probes have metal on all layers; lpflow cells belong to designs with several supplies
    dont_use=(f"{LIBRARY}__probe*", f"{LIBRARY}__lpflow*"),
    gds={part.lef: part.gds for part in chain(*zip_longest(layers.METALS, layers.VIAS)) if part},
    outline=layers.PRBOUNDARY,
    pin_datatype=layers.PIN,
    label_datatype=layers.LABEL,
)
