"""SKY130 for the extraction of cells: poly to met2."""

from collections.abc import Collection

from talbot.platforms.extraction import ExtractionPlatform
from talbot.platforms.sky130 import layers


def model(kind: str, width: float, marks: Collection[str]) -> str:
    """Name of the transistor model. kind: 'n' or 'p'; width: um; marks: which of hvtp, lvtn, library cover the gate.

    A narrow transistor inside a library cell is one of SkyWater's special ones (its cells' netlists: below 0.42 um).
    """
    special = "special_" if "library" in marks and width < 0.415 else ""
    threshold = "_hvt" if kind == "p" and "hvtp" in marks else "_lvt" if "lvtn" in marks else ""
    return f"sky130_fd_pr__{special}{kind}fet_01v8{threshold}"


_VIAS = layers.LICON, layers.MCON, layers.VIA
PLATFORM = ExtractionPlatform(
    conductors=(layers.POLY, layers.LI1, layers.MET1, layers.MET2),
    crossings=layers.CROSSINGS,
    vias=_VIAS,
    devices={
        "diff": layers.DIFF,
        "tap": layers.TAP,
        "nwell": layers.NWELL,
        "nsdm": layers.NSDM,
        "psdm": layers.PSDM,
        "hvtp": layers.HVTP,
        "lvtn": layers.LVTN,
        "library": layers.CELL_CORE,
    },
    outlines=(layers.PRBOUNDARY, layers.CELL_OUTLINE),
    well_labels=(layers.NWELL_LABEL, layers.PWELL_LABEL),
    halo_um=8.0,
    contact_ohm=layers.LICON_OHM | {via.below[-1]: via.ohm for via in _VIAS},
    model=model,
)
