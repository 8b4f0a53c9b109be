"""Design rules of the die, by PDKMaster's deck and by the foundry's."""

from talbot.flow.layout.steps.drc import Drc
from talbot.signoff.foundry_drc import FoundryDrc


class DieDrc(Drc):
    """`Drc` of the die without the pixels and the pads' transistors, which have checks of their own."""

    name = "die_drc"
    inputs = {"gds": "die_gds.checked", "deck": "library.drc"}


class DieFoundryDrc(FoundryDrc):
    """`FoundryDrc` of what `DieDrc` checks."""

    name = "die_foundry_drc"
    inputs = {"gds": "die_gds.checked", "deck": "foundry.klayout"}
