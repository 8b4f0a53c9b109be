"""SKY130 for drawn pixels.

Masks: SkyWater's layer table. hvi is thick oxide, hvntm the tip implant of its n transistors; both enclose the active
area, hvi by 0.18 um (hvdifftap.22; a gate by 0.20), hvntm by 0.185 um (hvntm.3). Transistor: the 5 V device, the only
one whose gate is on a line above the 3.3 V of the diode. Diode: the n well in the substrate, the model of SkyWater's
nwdiode (junction capacitance by area and perimeter).
"""

from pathlib import Path

from talbot.platforms.pixel import PixelProcess
from talbot.platforms.sky130 import layers

HVI, HVNTM, NPC = (75, 20), (125, 20), (95, 20)

PROCESS = PixelProcess(
    name="sky130",
    active=layers.DIFF,
    tap=layers.TAP,
    well=layers.NWELL,
    nplus=layers.NSDM,
    pplus=layers.PSDM,
    poly=layers.POLY.gds,
    contact=layers.LICON.gds,
    contact_poly=NPC,
    thick=((HVI, 0.20), (HVNTM, 0.185)),
    metals=layers.METALS,
    vias=layers.VIAS,
    outline=layers.PRBOUNDARY,
    fill_blocks=layers.FILL_BLOCKS,
    grid_um=0.005,
    transistor="sky130_fd_pr__nfet_g5v0d10v5",
    diode="sky130_fd_pr__model__parasitic__diode_ps2nw",
    deck_model="sky130_fd_pr__nfet_g5v0d10v5__model",
    deck_diode="nwdiode",
    supply_v=3.3,
    gate_v=5.0,
    masks=Path(__file__).with_name("pixel.drc"),
    lvs=Path(__file__).with_name("pixel.lvs"),
    density_most=0.6,
)
