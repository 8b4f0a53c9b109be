"""SG13G2's layers, to find what a cell's layout holds. Their stray capacitances are in coriolis.py; the
resistances of wires and contacts are not known here.

Layers: gds_layers of c4m-pdk-ihpsg13g2. N diffusion is what has no pSD, taps lie in the layer of all diffusion.
"""

from platforms.process import DIFFUSION, Process, Wire

PROCESS = Process(
    wires=(
        Wire("poly", (5, 0), (5, 25), (5, 2), 0.0, 0.0, 0.0, 0.0, 0.0),
        Wire("Metal1", (8, 0), (8, 25), (8, 2), 0.0, 0.0, 0.0, 0.0, 0.0),
    ),
    crossings=(),
    cuts=(((6, 0), (DIFFUSION, "poly"), "Metal1"),),
    devices={"diff": (1, 0), "nwell": (31, 0), "psdm": (14, 0)},
    outlines=((189, 0),),
    well_labels=(),
    halo=0.0,
    contacts={},
)


def model(kind, width, marks):
    """Name of the transistor model. kind: 'n' or 'p'; width (um) and marks do not matter here."""
    return f"sg13_lv_{kind}mos"
