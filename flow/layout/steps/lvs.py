"""Layout against netlist, down to transistors: the deck that PDKMaster exports for the process, in KLayout."""

from flow.steps import Step, StepError

from .. import netlist as netlist_module
from ..netlist import SUPPLIES, Netlist
from . import klayout_decks
from .klayout_decks import run_deck


class Lvs(Step):
    """The reference is the final netlist with the cells' transistor netlists; every port must match by name."""

    name = "lvs"
    inputs = {"gds": "stream_out.gds", "spice": "stream_out.spice", "netlist": "place_route.netlist",
              "deck": "library.lvs"}
    outputs = {"report": "lvs.lvsdb", "deck": "ports.lvs"}
    metrics = {"lvs_match": ""}
    uses = (klayout_decks, netlist_module)
    tools = ("klayout",)

    def run(self, inputs, outputs):
        netlist = Netlist.read(inputs["netlist"])
        outputs["deck"].write_text(with_ports(inputs["deck"].read_text(), netlist))
        log = outputs["report"].with_suffix(".log")
        run_deck(outputs["deck"], {"SOURCE_FILE": inputs["gds"].resolve(), "CELL_NAME": "",
                                   "SPICE_FILE": inputs["spice"].resolve(),
                                   "REPORT_FILE": outputs["report"].resolve()}, log)
        said = log.read_text()
        if not outputs["report"].exists() or ("LVS OK" in said) == ("LVS Failed" in said):
            raise StepError(f"lvs: KLayout gave no verdict: {said.strip().splitlines()[-1:]}")
        return {"lvs_match": "LVS OK" in said}


def with_ports(deck, netlist):
    """The deck, ports of the same name given as matching: where the comparison starts, and what it must end with."""
    if "\nalign\n" not in deck:
        raise StepError("lvs: the deck has no 'align'")
    names = [net for port in netlist.ports for net in port.bits()] + list(SUPPLIES)
    lines = "".join(f'same_nets!("{netlist.name}", "{net}", "{net}")\n' for net in names)
    return deck.replace("\nalign\n", f"\nalign\n{lines}")
