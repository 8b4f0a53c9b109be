"""Design rules of the die, by PDKMaster's deck and by the foundry's."""

from talbot.flow.layout.steps.drc import Drc
from talbot.platforms.analog import analog_masks
from talbot.platforms.pixel import PROCESSES
from talbot.signoff.foundry_drc import FoundryDrc
from talbot.signoff.geometry.decks import with_taps, without_rules


class DieDrc(Drc):
    """`Drc` of the die without the pixels and the pads' transistors, which have checks of their own.

    Where analog circuits are drawn, taps have a mask of their own, and the rules that SkyWater's own low-threshold
    transistors break are left out.
    """

    name = "die_drc"
    inputs = {"gds": "die_gds.checked", "deck": "library.drc"}

    def exported(self, deck: str) -> str:
        """The deck with taps, without those rules."""
        pdk = self.parameters.pdk
        if pdk not in PROCESSES:
            return deck
        masks = analog_masks(pdk)
        return without_rules(with_taps(deck, masks.base.active, masks.base.tap), masks.contradicted)


class DieFoundryDrc(FoundryDrc):
    """`FoundryDrc` of what `DieDrc` checks."""

    name = "die_foundry_drc"
    inputs = {"gds": "die_gds.checked", "deck": "foundry.klayout"}
