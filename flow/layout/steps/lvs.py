"""Layout against netlist, down to transistors: the deck that PDKMaster exports for the process, in KLayout."""

import json
from typing import Any

from talbot.base.steps import Files, Step, StepError
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.platforms.layout import layout_platform
from talbot.signoff.geometry.decks import run_exported
from talbot.signoff.geometry.lvs_deck import hierarchical, with_ports
from talbot.signoff.netlist.netlist import Netlist, supplies


class Lvs(Step[PdkParameters]):
    """The reference is the final netlist with the cells' transistor netlists; every port must match by name.

    A port that no cell is on is no net to KLayout; that it has its metal, and is no short, `extraction` checks.

    A cell is compared once, transistor by transistor, and its instances by their pins: a fifth of the flat comparison's
    time for 1,300 cells, and less for more.
    """

    name = "lvs"
    inputs = {"gds": "fill.gds", "spice": "stream_out.spice", "netlist": "stream_out.netlist", "deck": "library.lvs"}
    inputs |= {"plan": "stream_out.plan"}
    outputs = {"report": "lvs.lvsdb", "deck": "ports.lvs"}
    metrics = {"lvs_match": ""}
    tools = ("klayout",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        tech = layout_platform(self.parameters.pdk)
        deck = hierarchical(inputs["deck"].read_text(encoding="utf-8"), *filter(None, (tech.active, tech.tap)))
        outputs["deck"].write_text(
            with_ports(
                deck, Netlist.read(inputs["netlist"]), supplies(json.loads(inputs["plan"].read_text(encoding="utf-8")))
            ),
            encoding="utf-8",
        )
        _, output = run_exported(outputs["deck"], inputs["gds"], outputs["report"], SPICE_FILE=inputs["spice"])
        if not outputs["report"].exists() or ("LVS OK" in output) == ("LVS Failed" in output):
            raise StepError(f"lvs: KLayout gave no verdict: {output.strip().splitlines()[-1:]}")
        return {"lvs_match": "LVS OK" in output}
