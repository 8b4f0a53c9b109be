"""The routed layout as GDS with the design's own names, and the final netlist as Verilog and SPICE."""

import json
from dataclasses import dataclass

from base.gds import write_gds
from base.steps import Step, StepError
from platforms.coriolis import coriolis_platform

from ..geometry import area, notch, trim
from ..netlist import netlist as netlist_module
from ..netlist.names import plain_names
from ..netlist.netlist import SUPPLIES, Netlist


@dataclass(frozen=True)
class StreamOutParameters:
    """pdk: process. clock: name of the clock port. assembled: whether there are blocks laid out before in it."""

    pdk: str = "sky130"
    clock: str = "clk"
    assembled: bool = False


class StreamOut(Step):
    """Labels get the names of the ports, on the layers that the process's decks read. The Verilog has no hierarchy; in
    the SPICE a block is a subcircuit."""

    name = "stream_out"
    inputs = {
        "gds": "reroute.gds",
        "netlist": "place_route.netlist",
        "synthesized": "synthesis.netlist",
        "cells": "library.spice",
        "rules": "library.rules",
        "geometry": "library.geometry",
    }
    outputs = {"gds": "layout.gds", "verilog": "final.v", "spice": "reference.spi"}
    Parameters = StreamOutParameters
    metrics = {
        "width_um": "um",
        "height_um": "um",
        "area_um2": "um2",
        "instances": "",
        "trimmed": "",
        "grown": "",
        "notches": "",
    }
    uses = (area, netlist_module, notch, trim)
    tools = ("python klayout",)

    def __init__(self, parameters):
        super().__init__(parameters)
        if parameters.assembled:
            self.inputs = self.inputs | {"gds": "assemble.gds", "cells": "assemble.spice", "flat": "assemble.netlist"}

    def run(self, inputs, outputs):
        p = self.parameters
        known = coriolis_platform(p.pdk)
        netlist = Netlist.read(inputs["netlist"])
        names = {plain: net for net, plain in plain_names(Netlist.read(inputs["synthesized"]), p.clock).items()}
        ports = {net for port in netlist.ports for net in port.bits()} | set(SUPPLIES)
        rules = json.loads(inputs["rules"].read_text())
        box, changed = relabel(inputs["gds"], outputs["gds"], netlist.name, names, ports, known, rules)
        flat = Netlist.read(inputs["flat"]) if "flat" in inputs else netlist
        outputs["verilog"].write_text(flat.verilog())
        outputs["spice"].write_text(netlist.spice(inputs["cells"].read_text()))
        return {
            "width_um": round(box.width(), 3),
            "height_um": round(box.height(), 3),
            "area_um2": round(box.width() * box.height(), 2),
            "instances": len(flat.instances),
        } | changed


def relabel(source, target, top_name, names, ports, known, rules):
    """Write ``source`` as ``target``; returns (the top cell's box in um, dict: wires' ends 'trimmed', pads 'grown',
    'notches' filled).

    rules: the library's, of wires. names: dict Coriolis's name -> net. Of a port's labels that at the west or the
    east edge stays, with its name, and all of the supplies: where a net was routed anew, the others lie where its wires
    were, and fill may come there. Coriolis's blockages go. Raises StepError when a port has no label.
    """
    import klayout.db as db

    layout = db.Layout()
    layout.read(str(source))
    (top,) = layout.top_cells()
    top.name = top_name
    found, edges = {}, top.bbox()
    for wire in known.metals:
        label = layout.layer(*wire.label)
        pin = layout.layer(*wire.pin)
        texts = top.shapes(layout.layer(wire.layer, 0))
        labels = list(texts.each(db.Shapes.STexts))
        for shape in labels:
            net = names.get(shape.text.string, shape.text.string)
            if net in ports:
                found.setdefault(net, []).append((_from_edge(edges, shape.text), (label, pin), shape.text.trans))
        for shape in labels:
            shape.delete()
        if wire.datatype:  # else it is where the wires themselves are
            texts.clear()
    if ports - set(found):
        raise StepError(f"stream_out: ports without a pin in the layout: {', '.join(sorted(ports - set(found))[:5])}")
    kept = {layout.layer(*wire.pin): [] for wire in known.metals}
    for net, texts in found.items():
        for _, layers, place in texts if net in SUPPLIES else [min(texts, key=lambda text: text[0])]:
            kept[layers[-1]].append(place.disp)
            for layer in layers:
                top.shapes(layer).insert(db.Text(net, place))
    for layer, places in kept.items():
        _clear_pins(top.shapes(layer), places)
    for info in [info for info in layout.layer_infos() if info.layer == known.blockage_layer]:
        layout.clear_layer(layout.layer(info))
    changed = {
        "notches": notch.fill(layout, top, known.metals, rules["space_um"]),
        "trimmed": trim.trim(layout, top, known.metals, rules["space_um"]),
        "grown": area.grow(layout, top, known.metals, rules["metals"]),
    }
    write_gds(layout, target)
    return top.dbbox(), changed


def _clear_pins(shapes, places):
    """Leave of the boxes ``shapes`` of a pins' layer, for each of ``places``, the least one around it. Coriolis marks all
    wires of a port's net as pins, also where `reroute` moved them, and decks take a pin for metal."""
    import klayout.db as db

    boxes = [shape.bbox() for shape in shapes.each(db.Shapes.SAll - db.Shapes.STexts)]
    least = [
        min((box for box in boxes if box.contains(db.Point() + place)), key=db.Box.area, default=None)
        for place in places
    ]
    for shape in list(shapes.each(db.Shapes.SAll - db.Shapes.STexts)):
        shape.delete()
    for box in filter(None, least):
        shapes.insert(box)


def _from_edge(edges, text):
    return min(text.x - edges.left, edges.right - text.x)
