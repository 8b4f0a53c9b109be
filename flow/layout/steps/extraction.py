"""Parasitics of every net from the finished layout, as SPEF at the corners of wires."""

from typing import Any

from talbot.base.gds import read_gds
from talbot.base.steps import Files, Step
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.flow.layout.steps.routed import PREFIX, of_routed
from talbot.platforms.extraction import extraction_platform
from talbot.platforms.layout import layout_platform
from talbot.signoff.netlist.netlist import Netlist
from talbot.signoff.parasitics.extract import extract
from talbot.signoff.parasitics.spef import spef


class Extraction(Step[PdkParameters]):
    """Capacitances with coupling, of all shapes, and every net as a tree of resistors.

    A corner of cells is timed with the wires of `platforms.wires.wire_corner`. Metrics: at the typical corner; a net's
    resistance is that of all of its segments.
    """

    name = "extraction"
    inputs = {"gds": "fill.gds", "netlist": "stream_out.netlist", "placement": "stream_out.placement"}
    outputs = {"typ": "parasitics.spef", "min": "parasitics.min.spef", "max": "parasitics.max.spef"}
    metrics = {"wire_pf": "pF", "largest_ff": "fF", "largest_ohm": "Ohm"}
    tools = ("python klayout",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        pdk, netlist = self.parameters.pdk, Netlist.read(inputs["netlist"])
        tech, devices = layout_platform(pdk), extraction_platform(pdk)
        layout, corners = read_gds(inputs["gds"]), [tech.wires[name] for name in outputs]
        found = list(extract(layout, netlist, inputs["placement"], tech, devices, corners))
        for name, nets in zip(outputs, found, strict=True):
            outputs[name].write_text(spef(netlist, nets), encoding="utf-8")
        ff = [net.femtofarad for net in found[0].values()]
        ohm = max(sum(ohm for *_, ohm in net.resistors) for net in found[0].values())
        return {"wire_pf": round(sum(ff) / 1000, 3), "largest_ff": round(max(ff), 2), "largest_ohm": round(ohm, 1)}


class RoutedExtraction(Extraction):
    """The same of the routed layout."""

    name = f"{PREFIX}{Extraction.name}"
    inputs = of_routed(Extraction.inputs)
