"""Layout against netlist, down to transistors: the deck that PDKMaster exports for the process, in KLayout."""

import re
from dataclasses import dataclass

from base.steps import Step, StepError
from platforms.coriolis import coriolis_platform

from ..netlist import netlist as netlist_module
from ..netlist.netlist import SUPPLIES, Netlist
from . import klayout_decks
from .klayout_decks import run_deck


@dataclass(frozen=True)
class LvsParameters:
    """pdk: process."""

    pdk: str = "sky130"


class Lvs(Step):
    """The reference is the final netlist with the cells' transistor netlists; every port must match by name.

    A cell is compared once, transistor by transistor, and its places by their pins: a fifth of the flat comparison's
    time for 1,300 cells, and less for more.
    """

    name = "lvs"
    inputs = {"gds": "fill.gds", "spice": "stream_out.spice", "netlist": "place_route.netlist", "deck": "library.lvs"}
    outputs = {"report": "lvs.lvsdb", "deck": "ports.lvs"}
    Parameters = LvsParameters
    metrics = {"lvs_match": ""}
    uses = (klayout_decks, netlist_module)
    tools = ("klayout",)

    def run(self, inputs, outputs):
        known = coriolis_platform(self.parameters.pdk)
        deck = hierarchical(inputs["deck"].read_text(), known.active)
        outputs["deck"].write_text(with_ports(deck, Netlist.read(inputs["netlist"])))
        log = outputs["report"].with_suffix(".log")
        run_deck(
            outputs["deck"],
            {
                "SOURCE_FILE": inputs["gds"].resolve(),
                "CELL_NAME": "",
                "SPICE_FILE": inputs["spice"].resolve(),
                "REPORT_FILE": outputs["report"].resolve(),
            },
            log,
        )
        said = log.read_text()
        if not outputs["report"].exists() or ("LVS OK" in said) == ("LVS Failed" in said):
            raise StepError(f"lvs: KLayout gave no verdict: {said.strip().splitlines()[-1:]}")
        return {"lvs_match": "LVS OK" in said}


def hierarchical(deck, active):
    """The deck, cell by cell instead of flat. active: (GDS layer, datatype) of what transistors and taps lie in.

    The substrate must then be in every cell and not around all of them: it is where something active lies on it, and
    one net everywhere, as the wafer is.
    """
    changes = (
        (r"^flat$", "deep"),
        (r"^_wafer = extent.*$", f"_wafer = input{active}"),
        (r"^connect\((substrate__\w+), _wafer\)$", r'connect_global(\1, "SUBSTRATE")'),
    )
    for pattern, text in changes:
        deck, found = re.subn(pattern, text, deck, flags=re.M)
        if found != 1:
            raise StepError(f"lvs: the deck has {found} lines like {pattern}, one was expected")
    return deck


def with_ports(deck, netlist):
    """The deck, ports of the same name given as matching: where the comparison starts, and what it must end with."""
    if "\nalign\n" not in deck:
        raise StepError("lvs: the deck has no 'align'")
    names = [net for port in netlist.ports for net in port.bits()] + list(SUPPLIES)
    lines = "".join(f'same_nets!("{netlist.name}", "{net}", "{net}")\n' for net in names)
    return deck.replace("\nalign\n", f"\nalign\n{lines}")
