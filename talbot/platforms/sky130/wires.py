"""SKY130's wires at their three corners.

Capacitance: fitted to the tables that OpenROAD's extractor has for SKY130, rules.openrcx.sky130A.{nom,min,max}.calibre
of open_pdks [OpenPdks], whose values come from Calibre xRC on SkyWater's own decks: lines of minimum width over and
under planes of the other layers, 12 distances of each. With one RATE, SCREENING and NORM for all layers and corners the
model is within 3 % of them (root mean square; 13 % at worst) at the nominal and the least corner, 4 % (19 %) at the
most. Overlap: SkyWater's (as Magic's sky130.tech has them), at the other corners by the heights that the capacitance of
a line over a plane then gives [SakuraiTamaru1983]; poly and diffusion in proportion to Magic's. Magic's own tables have
15 to 70 % more for a line between planes, and its model adds what each plane and neighbour has without the others.
Resistance: Magic's sky130.tech, styles ngspice(), (lrlc), (hrhc).
"""

from talbot.platforms.layers import Crossing
from talbot.platforms.wires import CORNERS, Wires, rows

RATE, SCREENING, NORM = 0.025, 1 / 3, 2.0
# Upper and lower layer | aF/um2 of their overlap: typ, min, max | aF/um of an edge of the upper one to the lower
# | aF/um of an edge of the lower one to the upper
CROSSINGS = """
li1  substrate |  37.0  29.0  46.1 |  36.9  34.6  39.0
li1  diffusion |  55.3  43.4  68.9 |  40.1  37.7  42.4
li1  poly      |  94.2  64.8 129.4 |  39.4  36.0  43.3 |  25.3  23.3  28.5
met1 substrate |  25.8  19.6  30.7 |  40.7  38.8  40.8
met1 diffusion |  33.6  25.6  40.0 |  43.3  41.2  43.3
met1 poly      |  44.8  30.9  61.6 |  35.5  32.5  39.0 |  16.8  15.5  18.9
met1 li1       | 114.2  78.6 156.9 |  45.2  41.4  49.7 |  34.9  32.2  39.4
met2 substrate |  17.5  14.1  20.2 |  39.5  37.7  39.4
met2 diffusion |  20.8  16.7  24.1 |  41.4  39.5  41.3
met2 poly      |  24.5  20.0  27.4 |  36.7  35.0  37.2 |  15.9  14.9  17.1
met2 li1       |  37.6  30.6  42.1 |  41.2  39.3  41.7 |  31.0  29.1  33.3
met2 met1      | 133.9  89.7 217.5 |  45.8  41.7  53.6 |  45.0  39.9  54.7
met3 substrate |  12.4  10.0  14.4 |  42.1  41.6  43.8
met3 diffusion |  14.2  11.5  16.6 |  43.4  42.9  45.1
met3 poly      |  16.1  14.8  19.1 |  41.8  40.5  43.9 |  12.0  11.1  13.4
met3 li1       |  20.8  19.2  24.7 |  44.8  43.5  47.1 |  19.8  18.2  22.0
met3 met1      |  34.5  28.0  42.8 |  46.1  44.6  47.7 |  26.8  25.1  28.7
met3 met2      |  86.2  65.1 119.2 |  51.6  48.0  56.8 |  35.3  32.5  40.2
met4 substrate |   8.4   7.3  10.6 |  41.6  41.1  43.1
met4 diffusion |   9.4   8.1  11.8 |  42.6  42.1  44.2
met4 poly      |  10.0   9.8  12.2 |  41.3  41.2  41.2 |   9.8   9.0  10.9
met4 li1       |  11.7  11.4  14.2 |  43.0  43.0  42.9 |  15.7  14.4  17.5
met4 met1      |  15.0  13.7  18.3 |  44.4  43.9  45.5 |  18.8  18.6  17.9
met4 met2      |  20.3  18.5  24.5 |  44.2  43.6  45.4 |  21.6  21.3  19.9
met4 met3      |  84.0  62.7 133.5 |  47.8  44.0  55.4 |  50.4  45.1  57.3
"""
# aF times length / (distance + um): typ, min, max | um
SIDEWALLS = """
li1  |  30.7  34.9  26.9 | 0.192 0.302 0.108
met1 |  48.1  53.5  51.9 | 0.277 0.403 0.299
met2 |  51.8  56.8  56.9 | 0.315 0.439 0.336
met3 |  96.5  99.1  94.0 | 0.502 0.699 0.482
met4 | 107.1 111.5 109.0 | 0.626 0.832 0.628
"""
# Ohm of a square, of a via: typ, min, max
OHMS = """
poly   |  48.2  42.2  55.8
licon1 | 152.0  52.0 252.0
li1    |  12.8  10.5  17.0
mcon   |   9.3   1.6  23.0
met1   | 0.125 0.105 0.145
via    |   4.5   2.0  15.0
met2   | 0.125 0.105 0.145
via2   |  3.41   0.5   8.0
met3   | 0.047 0.038 0.056
via3   |  3.41   0.5   8.0
met4   | 0.047 0.038 0.056
"""


def _wires(k: int) -> Wires:
    crossings = []
    for (upper, lower), groups in rows(CROSSINGS):
        overlap, down, up = (group[k] for group in (groups + [[0.0] * 3])[:3])
        crossings.append(Crossing(upper, lower, overlap, down, up))
    sidewalls = {layer: (aF[k], um[k]) for (layer,), (aF, um) in rows(SIDEWALLS)}
    ohms = {name: ohm[k] for (name,), (ohm,) in rows(OHMS)}
    return Wires(tuple(crossings), sidewalls, ohms, RATE, SCREENING, NORM)


WIRES = {corner: _wires(k) for k, corner in enumerate(CORNERS)}
