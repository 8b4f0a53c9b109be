"""SKY130 with the cells of cells.compact for OpenROAD.

Tracks: met1 and met2 at half a site. Cells are drawn so that each pin can be met at a multiple of that; at 0.39 and
0.52 um 5 of the cells' 196 pins have no place for mcon and via, and detailed routing does not end. Two such tracks next
to each other cannot both be used, so global routes get a tenth of met1 and a third of met2. met3 and met4: SkyWater's
pitch, at which vias on neighbouring tracks keep their space. Resistance: as in `openroad`; capacitance: more, as these
cells are denser.
"""

from itertools import chain, zip_longest

from talbot.platforms.place_and_route import PlaceAndRoute, Strap
from talbot.platforms.sky130.layout import PLATFORM as LAYOUT
from talbot.platforms.sky130.openroad import PLATFORM as FOUNDRY
from talbot.platforms.twins import TWIN

DENSE = 1.25  # of capacitances: the chip's nets of 5 to 50 fF are extracted 19 to 26 % above estimates without it

PLATFORM = PlaceAndRoute(
    new_buffers=False,  # registers without an enable are behind buffers that are as slow as clock gates
    site="compact",
    site_um=LAYOUT.site_um,
    row_um=LAYOUT.row_um,
    supply=("vdd", ("vdd",)),
    ground=("vss", ("vss",)),
    buffer=("buf_x1", "i", "q"),
    diode="diode_w1",
    clock_root="buf_x4",
    clock_buffers=("buf_x2", "buf_x4", "buf_x8"),
    straps=(Strap("met1", LAYOUT.rail_um), Strap("met4", LAYOUT.strap_um, 49.92, 12.48)),
    strap_columns=2,  # with all that fit, cells below a strap keep violations
    pins=("met3", "met2"),
    clear_um=0.7,
    signal=("met1", "met4"),
    clock=("met1", "met4"),
    kept_free={"met1": 0.9, "met2": 0.65, "met3": 0.3, "met4": 0.3},
    congestion_iterations=3,  # with 50 those of the chip do not end
    layer_rc={name: (ohm, DENSE * pf) for name, (ohm, pf) in FOUNDRY.layer_rc.items() if name != "met5"},
    via_rc={"mcon": 9.3e-3, "via": 4.5e-3, "via2": 3.41e-3, "via3": 3.41e-3},
    signal_rc=("met1", "met2"),
    clock_rc=("met2", "met3"),
    dont_use=(f"*{TWIN}",),  # until `thresholds` takes them
    fill=tuple(reversed(LAYOUT.fill_cells)),
    gds={part.lef: part.gds for part in chain(*zip_longest(LAYOUT.metals, LAYOUT.vias)) if part},
    outline=LAYOUT.outline,
    pin_datatype=LAYOUT.pin_datatype,
    label_datatype=LAYOUT.label_datatype,
    pitch_um={"li1": 0.52, "met1": 0.26, "met2": 0.26, "met3": 0.68, "met4": 0.68},
    density_addon=0.2,
    setup_margin_ns=0.3,
    hold_margin_ns=0.1,
)
