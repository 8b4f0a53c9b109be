"""The routed layout as GDS with the design's own names, and the final netlist as Verilog and SPICE."""

import json
from dataclasses import dataclass
from typing import Any

from talbot.base.gds import read_gds, write_gds
from talbot.base.steps import Files, Step
from talbot.platforms.coriolis import coriolis_platform

from ..geometry import area, notch, trim
from ..geometry.frame import into_frame, mark_straps
from ..geometry.labels import relabel
from ..netlist.netlist import SUPPLIES, Netlist, supplies, with_diodes

COUNTS = ("instances", "trimmed", "grown", "notches")


@dataclass(frozen=True)
class StreamOutParameters:
    """Parameters of `StreamOut`.

    pdk: process. assembled: whether there are macros in it.
    """

    pdk: str = "sky130"
    assembled: bool = False


class StreamOut(Step[StreamOutParameters]):
    """Ports labelled, narrow notches filled, segment ends trimmed, small pads grown; moved into the plan's frame.

    The Verilog has no hierarchy; in the SPICE a macro is a subcircuit, and there are the diodes, which do nothing.
    """

    name = "stream_out"
    inputs = {
        "gds": "route.gds",
        "netlist": "repair.netlist",
        "diodes": "route.diodes",
        "cells": "library.spice",
        "rules": "library.rules",
        "geometry": "library.geometry",
        "plan": "floorplan.floorplan",
    }
    outputs = {"gds": "layout.gds", "verilog": "final.v", "spice": "reference.spi"}
    metrics = {"width_um": "um", "height_um": "um", "area_um2": "um2", **dict.fromkeys(COUNTS, "")}
    tools = ("python klayout",)

    def __init__(self, parameters: StreamOutParameters) -> None:
        super().__init__(parameters)
        if parameters.assembled:
            assembled = {"gds": "assemble.gds", "cells": "assemble.spice", "flat": "assemble.netlist"}
            self.inputs = {**self.inputs, **assembled}

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        tech, layout = coriolis_platform(self.parameters.pdk), read_gds(inputs["gds"])
        netlist, plan = Netlist.read(inputs["netlist"]), json.loads(inputs["plan"].read_text(encoding="utf-8"))
        rules = json.loads(inputs["rules"].read_text(encoding="utf-8"))
        (top,) = layout.top_cells()
        top.name = netlist.name
        relabel(layout, {net for port in netlist.ports for net in port.bits()} | set(SUPPLIES), tech, supplies(plan))
        changed = {
            "notches": notch.fill(layout, top, tech.metals, rules["space_um"]),
            "trimmed": trim.trim(layout, top, tech.metals, rules["space_um"]),
            "grown": area.grow(layout, top, tech.metals, rules["metals"]),
        }
        outline = top.bbox()
        if "frame" in plan:
            outline = into_frame(layout, plan["frame"])
            mark_straps(layout, supplies(plan), tech)
        top.shapes(layout.layer(*tech.outline)).insert(outline)
        write_gds(layout, outputs["gds"])
        flat = Netlist.read(inputs["flat"]) if "flat" in inputs else netlist
        outputs["verilog"].write_text(flat.verilog(), encoding="utf-8")
        drawn = with_diodes(netlist, **json.loads(inputs["diodes"].read_text(encoding="utf-8")))
        outputs["spice"].write_text(
            drawn.spice(inputs["cells"].read_text(encoding="utf-8"), supplies(plan)), encoding="utf-8"
        )
        width, height = top.dbbox().width(), top.dbbox().height()
        size = {"width_um": round(width, 3), "height_um": round(height, 3), "area_um2": round(width * height, 2)}
        return size | {"instances": len(flat.instances)} | changed
