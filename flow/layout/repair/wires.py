"""The capacitance of a wire before it is routed."""

from talbot.platforms.coriolis import CoriolisPlatform
from talbot.platforms.wires import SUBSTRATE

SPACE_UM = 0.6  # from a wire to the next one on either side, as a mean over layouts


def femtofarad_um(tech: CoriolisPlatform, corner: str) -> float:
    """Capacitance (fF) of a um of wire, the mean over the layers that signals take; corner: of wires."""
    wires, metals, made = tech.wires[corner], tech.metals[1:-1], 0.0
    downwards = {made.upper: made for made in wires.crossings if made.lower == SUBSTRATE}
    for metal in metals:
        down, (attofarad, offset) = downwards[metal.lef], wires.sidewalls[metal.lef]
        made += metal.width_um * down.overlap_af_um2 + 2 * down.down_af_um + 2 * attofarad / (SPACE_UM + offset)
    return made / len(metals) / 1000
