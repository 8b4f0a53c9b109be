"""Antennas of the die's wires, before a net is whole."""

from dataclasses import replace

from flow.layout.steps import antenna
from flow.layout.steps.antenna import Antenna
from platforms.coriolis import CoriolisPlatform

from .routing import VERTICAL


class DieAntenna(Antenna):
    """As `Antenna`, of the whole die, for the wires below the verticals: up to these, a gate of the chip has nothing of
    the die but what lies at its pin. With them comes the net's driver, whose diffusion a frame does not have."""

    name = "die_antenna"
    inputs = {"gds": "die_gds.gds"}
    uses = (antenna,)

    def tech(self) -> CoriolisPlatform:
        tech = super().tech()
        return replace(tech, metals=tech.metals[:VERTICAL], vias=tech.vias[: VERTICAL - 1])
