"""SG13G2's layers and vias.

GDS numbers: gds_layers of c4m-pdk-ihpsg13g2. Capacitance to the substrate: ihp-sg13g2_tech.pb.json of klayout-pex
0.6.12. Resistance of metals, thickness, antenna ratios: IHP-Open-PDK's sg13g2_tech.lef. With a diffusion of 0.16 um2 on
a net the ratio is 3200, and 20,000 an um2 more; none here is smaller. IHP's limit is that of all layers together, the
one here that of each. The resistance of contacts, and capacitance between layers, are not known here.
"""

from functools import partial

from talbot.platforms.layers import DIFFUSION, Layer, Via

LABEL, PIN = 25, 2  # GDS datatypes
ACTIVE = 1, 0
NWELL, PSD = (31, 0), (14, 0)
PRBOUNDARY = 189, 0

_layer = partial(Layer, datatype=0, label_datatype=LABEL, pin_datatype=PIN)
_metal = partial(_layer, antenna_ratio=200, antenna_diffusion=(3200, 20000))
_upper = partial(_metal, sheet_ohm=0.103, thickness_um=0.45)

POLY = _layer(name="GatPoly", lef="poly", layer=5)
METALS = (
    _metal(
        name="Metal1", lef="Metal1", layer=8, area_af_um2=35.02, fringe_af_um=39.59, sheet_ohm=0.135, thickness_um=0.40
    ),
    _upper(name="Metal2", lef="Metal2", layer=10, area_af_um2=18.18, fringe_af_um=34.80),
    _upper(name="Metal3", lef="Metal3", layer=30, area_af_um2=11.99, fringe_af_um=31.35),
    _upper(name="Metal4", lef="Metal4", layer=50, area_af_um2=8.95, fringe_af_um=29.08),
    _upper(name="Metal5", lef="Metal5", layer=67, area_af_um2=7.14, fringe_af_um=27.53),
)
CONTACT = Via(name="Cont", lef="Cont", layer=6, datatype=0, below=(DIFFUSION, "poly"), above="Metal1")
VIAS = tuple(
    Via(
        name=f"Via{k}",
        lef=f"Via{k}",
        layer=layer,
        datatype=0,
        below=(f"Metal{k}",),
        above=f"Metal{k + 1}",
        size_um=0.19,
        space_um=0.29,
        enclosure_um=0.05,
        ohm=20.0,
    )
    for k, layer in enumerate((19, 29, 49, 66), 1)
)
