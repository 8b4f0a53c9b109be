"""SKY130's wires at their three corners.

Capacitance: SkyWater's tables (PEX/xRC/cap_models), as Magic's technology file has them [OpenPdks, sky130.tech, styles
ngspice(), (lrlc), (hrhc)]. Resistance: the same file. There are corners of nothing else here: the sheet of met5 and
what is not listed is in platforms.sky130.layers.
"""

from platforms.layers import Crossing
from platforms.wires import CORNERS, Wires, rows

# Upper and lower layer | aF/um2 of their overlap: typ, min, max | aF/um of an edge of the upper one to the lower
# | aF/um of an edge of the lower one to the upper
CROSSINGS = """
li1  substrate |  36.99  29.30  49.70 |  40.70  35.69  47.02
li1  diffusion |  55.30  45.30  70.90 |  44.27  39.59  49.94
li1  poly      |  94.16  64.50 174.00 |  51.85  43.75  66.60 |  25.14  21.21  32.29
met1 substrate |  25.78  20.20  35.70 |  40.57  34.41  49.59
met1 diffusion |  33.60  26.70  45.40 |  43.10  37.22  51.17
met1 poly      |  44.81  32.30  73.20 |  46.72  40.34  59.78 |  16.69  14.41  21.36
met1 li1       | 114.20  77.20 215.00 |  59.50  49.46  80.12 |  34.70  28.84  46.73
met2 substrate |  17.50  14.00  23.50 |  37.76  32.60  46.03
met2 diffusion |  20.80  16.80  27.40 |  39.54  34.16  47.45
met2 poly      |  24.50  18.90  35.50 |  41.22  34.46  51.29 |  11.17   9.34  13.90
met2 li1       |  37.56  28.60  52.30 |  46.28  39.67  55.56 |  21.74  18.63  26.10
met2 met1      | 133.86  80.40 313.00 |  67.05  53.85 102.37 |  48.19  38.70  73.58
met3 substrate |  12.37  10.20  16.30 |  40.99  36.05  47.38
met3 diffusion |  14.20  11.70  18.10 |  42.25  37.59  48.19
met3 poly      |  16.06  12.60  21.30 |  43.53  38.28  50.44 |   9.18   8.07  10.64
met3 li1       |  20.79  16.30  26.30 |  46.71  41.75  53.29 |  15.08  13.48  17.20
met3 met1      |  34.54  25.80  45.20 |  54.81  48.82  62.88 |  26.68  23.76  30.61
met3 met2      |  86.19  59.50 131.00 |  69.85  61.18  82.67 |  44.43  38.92  52.59
met4 substrate |   8.42   7.28  10.70 |  36.68  32.39  42.40
met4 diffusion |   9.41   7.98  11.40 |  37.57  33.54  43.00
met4 poly      |  10.01   8.42  12.60 |  38.11  33.59  43.99 |   6.35   5.60   7.33
met4 li1       |  11.67   9.92  14.30 |  39.71  35.49  45.09 |  10.14   9.06  11.51
met4 met1      |  15.03  12.80  18.50 |  42.56  38.29  48.07 |  16.42  14.77  18.55
met4 met2      |  20.33  17.80  25.20 |  46.38  42.08  51.98 |  22.33  20.26  25.03
met4 met3      |  84.03  57.60 191.00 |  70.52  59.42  92.12 |  42.64  35.93  55.70
met5 substrate |   6.32   5.56   7.76 |  38.85  34.65  44.91
met5 diffusion |   6.88   5.96   8.14 |  39.52  35.55  45.47
met5 poly      |   7.21   6.20   8.74 |  39.91  35.59  46.31 |   6.49   5.79   7.53
met5 li1       |   8.03   6.97   9.48 |  41.15  37.24  47.09 |   7.64   6.91   8.74
met5 met1      |   9.48   8.26  11.20 |  43.19  39.30  49.44 |  12.02  10.94  13.76
met5 met2      |  11.34  10.10  13.30 |  45.59  41.75  51.69 |  15.69  14.37  17.79
met5 met3      |  19.63  16.70  24.60 |  54.15  48.75  63.24 |  27.84  25.06  32.51
met5 met4      |  68.33  48.70 115.00 |  82.82  70.26 109.69 |  46.98  39.86  62.22
"""
# aF times length / (distance + um): typ, min, max | um
SIDEWALLS = """
li1  | 25.5 26.70 28.7 | 0.14 0.17 0.17
met1 | 44.0 35.60 37.6 | 0.25 0.14 0.14
met2 | 50.0 37.61 40.2 | 0.30 0.14 0.14
met3 | 74.0 52.00 60.6 | 0.40 0.30 0.30
met4 | 94.0 53.70 65.4 | 0.57 0.30 0.30
met5 | 155. 81.50 119. | 0.50 1.60 1.60
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
via4   |  0.38 0.012 0.891
met5   | 0.029 0.021 0.036
"""


def _wires(k: int) -> Wires:
    crossings = []
    for (upper, lower), groups in rows(CROSSINGS):
        overlap, down, up = (group[k] for group in (groups + [[0.0] * 3])[:3])
        crossings.append(Crossing(upper, lower, overlap, down, up))
    sidewalls = {layer: (aF[k], um[k]) for (layer,), (aF, um) in rows(SIDEWALLS)}
    return Wires(tuple(crossings), sidewalls, {name: ohm[k] for (name,), (ohm,) in rows(OHMS)})


WIRES = {corner: _wires(k) for k, corner in enumerate(CORNERS)}
