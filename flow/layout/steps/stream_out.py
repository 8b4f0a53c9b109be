"""The routed design as GDS, and its netlist as JSON, Verilog and SPICE: what all checks read."""

import json
import re
from dataclasses import dataclass, replace
from typing import Any

from talbot.base.gds import db, read_gds, write_gds
from talbot.base.steps import Files, Step, StepError
from talbot.flow.layout.steps.routed import PREFIX, of_routed
from talbot.platforms.layout import LayoutPlatform, layout_platform
from talbot.platforms.place_and_route import place_and_route
from talbot.signoff.geometry.merge import merge
from talbot.signoff.netlist.netlist import SUPPLIES, Netlist, is_register, with_diodes
from talbot.signoff.netlist.routed import Routed


@dataclass(frozen=True)
class StreamOutParameters:
    """Parameters of `StreamOut`. pdk: process. frame: of the process, or ''."""

    pdk: str = "sky130"
    frame: str = ""


class StreamOut(Step[StreamOutParameters]):
    """OpenROAD's DEF and the cells' GDS as one layout.

    plan: size, box of the rows (core), names of the supplies, in a frame its box. placement: the straps, (net, x in
    um), and of each instance of the netlist [None, cell, x, y, orientation]. The diodes are in the SPICE and in
    verilog_with_diodes, which leaves the flow; simulation and timing read the netlist without: they do nothing.
    """

    name = "stream_out"
    inputs = {
        "def": "finish.def",
        "synthesized": "synthesis.netlist",
        "tech_lef": "library.tech_lef",
        "cell_lef": "library.cell_lef",
        "cells": "library.gds",
        "spice": "library.spice",
        "areas": "library.areas",
    }
    outputs = {
        "gds": "layout.gds",
        "netlist": "netlist.json",
        "verilog": "final.v",
        "verilog_with_diodes": "complete.v",
        "spice": "reference.spi",
        "placement": "placement.json",
        "plan": "plan.json",
    }
    metrics = {"width_um": "um", "height_um": "um", "area_um2": "um2", "cells": "", "cell_area_um2": "um2"}
    metrics |= {"utilization": "", "flip_flops": "", "wire_um": "um", "vias": "", "diodes": "", "clock_buffers": ""}
    tools = ("python klayout",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        tech, tools = layout_platform(self.parameters.pdk), place_and_route(self.parameters.pdk)
        frame = tech.frame(self.parameters.frame) if self.parameters.frame else None
        supplies = frame.supplies if frame else SUPPLIES
        before, areas = Netlist.read(inputs["synthesized"]), json.loads(inputs["areas"].read_text(encoding="utf-8"))
        routed = Routed.read(inputs["def"], tools.straps[-1].layer, tech.row_um)
        netlist = routed.netlist(before.name, before.ports)
        if lost := {i.name for i in before.instances if is_register(i.cell)} - {i.name for i in netlist.instances}:
            raise StepError(
                f"stream_out: registers of the netlist are not in the layout: {', '.join(sorted(lost)[:3])}"
            )
        width, height = merge(
            inputs["def"], [inputs["tech_lef"], inputs["cell_lef"]], inputs["cells"], tools, outputs["gds"]
        )
        layout = read_gds(outputs["gds"])
        label(layout, tech)
        write_gds(layout, outputs["gds"])
        netlist.write(outputs["netlist"])
        outputs["verilog"].write_text(netlist.verilog(), encoding="utf-8")
        complete = with_diodes(netlist, routed.diodes(), {})
        outputs["verilog_with_diodes"].write_text(complete.verilog(), encoding="utf-8")
        library = inputs["spice"].read_text(encoding="utf-8")
        drawn = with_open_nets(complete, library)
        outputs["spice"].write_text(drawn.spice(library, supplies), encoding="utf-8")
        widths = {cell: area / tech.row_um for cell, area in areas.items()}
        straps = [(dict(zip(supplies, SUPPLIES, strict=True))[net], x) for net, x in routed.straps]
        placement = {"straps": straps, "instances": routed.instances(widths, tech.row_um)}
        outputs["placement"].write_text(json.dumps(placement, indent=0) + "\n", encoding="utf-8")
        size = {"width_um": width, "height_um": height}
        plan = size | {"core": routed.core_um, "supplies": supplies}
        if frame:
            plan["frame"] = [0.0, 0.0, width, height]
        outputs["plan"].write_text(json.dumps(plan, indent=1), encoding="utf-8")
        logic = [i for i in netlist.instances if i.pins]
        left, bottom, right, top = routed.core_um
        used = sum(areas[i.cell] for i in logic)
        return size | {
            "area_um2": round(width * height, 2),
            "cells": len(logic),
            "cell_area_um2": round(used, 2),
            "utilization": round(used / ((right - left) * (top - bottom)), 4),
            "flip_flops": sum(is_register(i.cell) for i in logic),
            "wire_um": routed.wire_um,
            "vias": routed.vias,
            "diodes": len(routed.diodes()),
            "clock_buffers": sum(i.name.startswith("clkbuf") for i in logic),
        }


class RoutedStreamOut(StreamOut):
    """The same of the routed layout."""

    name = f"{PREFIX}{StreamOut.name}"
    inputs = of_routed(StreamOut.inputs)


def label(layout: "db.Layout", tech: LayoutPlatform) -> None:
    """Put the ports' labels where the decks read them, too: on the layer of pins."""
    top = layout.top_cell()
    for metal in tech.metals:
        for shape in list(top.shapes(layout.layer(*metal.label)).each(db.Shapes.STexts)):
            top.shapes(layout.layer(*metal.pin)).insert(shape.text)
    for info in [info for info in layout.layer_infos() if info.layer == tech.blockage_layer]:
        layout.clear_layer(layout.layer(info))


def with_open_nets(netlist: Netlist, library: str) -> Netlist:
    """Give every pin of a cell that the netlist leaves out a new net. library: SPICE of the cells."""
    ports = {m[1]: m[2].split() for m in re.finditer(r"(?im)^\.subckt (\S+) (.*)$", library)}
    instances = []
    for number, i in enumerate(netlist.instances):
        nets = {pin: i.pins.get(pin, f"open{number}_{pin}") for pin in ports[i.cell] if pin not in SUPPLIES}
        instances.append(replace(i, pins=nets))
    return replace(netlist, instances=tuple(instances))
