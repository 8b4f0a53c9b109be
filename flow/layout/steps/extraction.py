"""Parasitics of every net from the routed segments, as SPEF."""

from typing import Any

from base.steps import Files, Step
from platforms.coriolis import coriolis_platform

from ..netlist.netlist import Netlist
from ..timing.parasitics import extract, spef
from .parameters import PdkParameters


class Extraction(Step[PdkParameters]):
    """From lengths and widths of the segments and the process's coefficients of each layer."""

    name = "extraction"
    inputs = {"netlist": "place.netlist", "placement": "route.placement"}
    outputs = {"spef": "parasitics.spef"}
    metrics = {"wire_pf": "pF", "largest_ff": "fF", "largest_ohm": "Ohm"}

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        netlist = Netlist.read(inputs["netlist"])
        nets = extract(netlist, inputs["placement"], coriolis_platform(self.parameters.pdk))
        outputs["spef"].write_text(spef(netlist, nets))
        ff, ohm = [net.femtofarad for net in nets.values()], max(net.ohm for net in nets.values())
        return {"wire_pf": round(sum(ff) / 1000, 3), "largest_ff": round(max(ff), 2), "largest_ohm": round(ohm, 1)}
