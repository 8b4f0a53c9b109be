"""SG13G2 for the extraction of transistors alone: there are no crossings and no resistances of contacts.

N diffusion is what has no pSD; taps are in the layer of all diffusion.
"""

from collections.abc import Collection

from talbot.platforms.extraction import ExtractionPlatform
from talbot.platforms.ihp_sg13g2 import layers


def model(kind: str, width: float, marks: Collection[str]) -> str:
    """Name of the transistor model. kind: 'n' or 'p'; width (um) and marks do not matter here."""
    return f"sg13_lv_{kind}mos"


PLATFORM = ExtractionPlatform(
    conductors=(layers.POLY, layers.METALS[0]),
    crossings=(),
    vias=(layers.CONTACT,),
    devices={"diff": layers.ACTIVE, "nwell": layers.NWELL, "psdm": layers.PSD},
    outlines=(layers.PRBOUNDARY,),
    well_labels=(),
    halo_um=0.0,
    contact_ohm={},
    model=model,
)
