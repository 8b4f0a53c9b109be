"""Antennas of the die's nets."""

from dataclasses import replace

from talbot.flow.layout.sensor.routing import BRANCH
from talbot.flow.layout.steps.antenna import Antenna
from talbot.platforms.layout import LayoutPlatform


class DieAntenna(Antenna):
    """`Antenna` of the whole die, for the metals below the branches.

    Below these, a gate of the chip is connected to nothing of the die but its stub. A branch connects it to the net's
    driver, whose diffusion a black box does not have.
    """

    name = "die_antenna"
    inputs = {"gds": "die_gds.checked"}

    def tech(self) -> LayoutPlatform:
        """The process without the branches' metal and those above."""
        tech = super().tech()
        return replace(tech, metals=tech.metals[:BRANCH], vias=tech.vias[: BRANCH - 1])
