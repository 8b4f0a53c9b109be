"""SG13G2's wires; the same at all three corners, since no others are known here.

Capacitance: those of IHP's technology file for Magic (IHP-Open-PDK, ihp-sg13g2.tech), as ihp-sg13g2_tech.pb.json of
klayout-pex has them. Resistance of poly and contacts: there, too; of metals and vias: platforms.ihp_sg13g2.layers.
"""

from talbot.platforms.ihp_sg13g2 import layers
from talbot.platforms.layers import Crossing
from talbot.platforms.wires import CORNERS, Wires, rows

# Upper and lower layer | aF/um2 of their overlap | aF/um of an edge of the upper one to the lower
# | aF/um of an edge of the lower one to the upper
CROSSINGS = """
Metal1 substrate |  35.02 | 39.59
Metal1 diffusion |  58.17 | 44.75
Metal1 poly      |  78.65 | 49.38 | 23.23
Metal2 substrate |  18.18 | 34.80
Metal2 diffusion |  22.92 | 36.95
Metal2 poly      |  25.54 | 37.62 | 10.80
Metal2 Metal1    |  67.22 | 49.54 | 31.07
Metal3 substrate |  11.99 | 31.35
Metal3 diffusion |  13.89 | 32.27
Metal3 poly      |  14.81 | 32.80 |  7.07
Metal3 Metal1    |  23.12 | 37.01 | 17.35
Metal3 Metal2    |  67.22 | 49.54 | 36.91
Metal4 substrate |   8.95 | 29.08
Metal4 diffusion |   9.96 | 29.75
Metal4 poly      |  10.43 | 30.10 |  5.24
Metal4 Metal1    |  13.96 | 32.16 | 12.40
Metal4 Metal2    |  23.12 | 36.34 | 22.33
Metal4 Metal3    |  67.22 | 49.54 | 40.02
Metal5 substrate |   7.14 | 27.53
Metal5 diffusion |   7.77 | 28.23
Metal5 poly      |   8.05 | 28.41 |  4.18
Metal5 Metal1    |  10.00 | 29.93 |  9.72
Metal5 Metal2    |  13.96 | 32.12 | 16.53
Metal5 Metal3    |  23.12 | 36.97 | 24.79
Metal5 Metal4    |  67.22 | 49.52 | 41.96
"""
# aF times length / (distance + um) | um
SIDEWALLS = """
Metal1 | 28.735 | -0.057
Metal2 | 40.981 | -0.033
Metal3 | 37.679 | -0.045
Metal4 | 49.526 |  0.004
Metal5 | 53.129 |  0.021
"""

WIRES = dict.fromkeys(
    CORNERS,
    Wires(
        tuple(
            Crossing(upper, lower, *(a for (a,) in [*groups, [0.0]][:3])) for (upper, lower), groups in rows(CROSSINGS)
        ),
        {layer: (aF, um) for (layer,), ((aF,), (um,)) in rows(SIDEWALLS)},
        {"poly": 48.2, "Cont": 15.0}
        | {part.lef: part.sheet_ohm for part in layers.METALS}
        | {via.lef: via.ohm for via in layers.VIAS},
    ),
)
