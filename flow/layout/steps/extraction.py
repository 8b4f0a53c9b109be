"""Capacitance and resistance of every net, from the wires that the router drew, as SPEF.

Each wire counts with its area and its two long edges to the substrate, each cut with its resistance. There is no
coupling between wires in it, and a net is one T: half of its whole resistance on either side of its capacitance,
which is more than any single path of a branched net has.
"""

import json

from base.steps import Step
from platforms.coriolis import coriolis_platform

from ..netlist.netlist import Netlist
from ..timing import parasitics as parasitics_module
from ..timing.parasitics import parasitics, spef
from .parameters import PdkParameters


class Extraction(Step):
    """From lengths and widths in the router's database and the process's coefficients per layer."""

    name = "extraction"
    inputs = {"netlist": "place_route.netlist", "placement": "reroute.placement", "liberty": "library.liberty"}
    outputs = {"spef": "wires.spef"}
    Parameters = PdkParameters
    metrics = {"wire_pf": "pF", "largest_ff": "fF", "largest_ohm": "Ohm"}
    uses = (parasitics_module,)

    def run(self, inputs, outputs):
        known = coriolis_platform(self.parameters.pdk)
        netlist = Netlist.read(inputs["netlist"])
        segments = json.loads(inputs["placement"].read_text())["segments"]
        there = {net for instance in netlist.instances for net in instance.pins.values()}
        nets = {net: parasitics(parts, known) for net, parts in segments.items() if net in there}
        outputs["spef"].write_text(spef(netlist, nets))
        return {
            "wire_pf": round(sum(c for c, _ in nets.values()) / 1000, 3),
            "largest_ff": round(max(c for c, _ in nets.values()), 2),
            "largest_ohm": round(max(r for _, r in nets.values()), 1),
        }
