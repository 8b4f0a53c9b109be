"""PDKMaster's LVS deck for KLayout, adapted."""

import re
from collections.abc import Sequence

from talbot.base.steps import StepError
from talbot.platforms.layers import GdsLayer
from talbot.signoff.netlist.netlist import SUPPLIES, Netlist


def hierarchical(deck: str, *active: GdsLayer) -> str:
    """The LVS deck, cell by cell instead of flat. active: layers of transistors and taps.

    The substrate must then be in every cell and not around all of them: it is where something active is on it, and
    one net everywhere, as the wafer is.
    """
    changes = (
        (r"^flat$", "deep"),
        (r"^_wafer = extent.*$", "_wafer = " + " + ".join(f"input{layer}" for layer in active)),
        (r"^connect\((substrate__\w+), _wafer\)$", r'connect_global(\1, "SUBSTRATE")'),
    )
    for pattern, text in changes:
        deck, found = re.subn(pattern, text, deck, flags=re.M)
        if found != 1:
            raise StepError(f"lvs: the deck has {found} lines like {pattern}, one was expected")
    return deck


def with_ports(deck: str, netlist: Netlist, supplies: Sequence[str] = SUPPLIES) -> str:
    """The LVS deck, ports of the same name given as matching: the comparison starts there, and they must match.

    Ports that no cell is on are not compared: see `Netlist.spice`.
    """
    if "\nalign\n" not in deck:
        raise StepError("lvs: the deck has no 'align'")
    names = [*netlist.connected_ports(), *supplies]
    lines = "".join(f'same_nets!("{netlist.name}", "{net}", "{net}")\n' for net in names)
    return deck.replace("\nalign\n", f"\nalign\n{lines}")
