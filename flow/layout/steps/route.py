"""Routing of all nets, with rules of space, area and antennas kept."""

import json
from dataclasses import dataclass
from typing import Any

from talbot.base.gds import read_gds, write_gds
from talbot.base.steps import Files, Step
from talbot.platforms.coriolis import coriolis_platform

from ..netlist.netlist import Netlist
from ..netlist.placed import pin_boxes
from ..route.board import Board
from ..route.diodes import Diodes
from ..route.negotiate import route
from ..route.rules import RoutingRules

EDGE_NM = 400  # from a frame to the middle of a segment, so that it is half a space inside


@dataclass(frozen=True)
class RouteParameters:
    """Parameters of `Route`. pdk: process."""

    pdk: str = "sky130"


class Route(Step[RouteParameters]):
    """Negotiated congestion on a grid, from nothing.

    open_nets: that found no path. evictions: times that a net was rerouted for another. respaced_nets: rerouted because
    of a rule of space or width. long_nets: longer than their drivers bear. diodes: against antennas.
    """

    name = "route"
    inputs = {
        "gds": "repair.gds",
        "netlist": "repair.netlist",
        "placement": "repair.placement",
        "shapes": "place.shapes",
        "masters": "place.masters",
        "rules": "library.rules",
        "geometry": "library.geometry",
        "cells": "library.gds",
        "areas": "library.areas",
        "plan": "floorplan.floorplan",
        "lengths": "repair.lengths",
    }
    outputs = {"gds": "routed.gds", "placement": "placement.json", "diodes": "diodes.json"}
    metrics = {
        "open_nets": "",
        "evictions": "",
        "respaced_nets": "",
        "long_nets": "",
        "diodes": "",
        "wire_um": "um",
        "vias": "",
    }
    tools = ("python klayout",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        tech = coriolis_platform(self.parameters.pdk)
        placement, shapes, masters, areas = (
            json.loads(inputs[name].read_text(encoding="utf-8")) for name in ("placement", "shapes", "masters", "areas")
        )
        pins = pin_boxes(Netlist.read(inputs["netlist"]), placement["instances"], masters)
        for net in pins.keys() | shapes.keys():
            made = shapes.setdefault(net, {"segments": [], "vias": [], "ports": []})
            made["pins"] = [*pins.get(net, []), *([box] for box in made.pop("ports"))]
        rules = RoutingRules.of(tech, json.loads(inputs["rules"].read_text(encoding="utf-8")))
        area, plan = None, json.loads(inputs["plan"].read_text(encoding="utf-8"))
        if "frame" in plan:
            left, bottom, right, top = (round(1000 * value) for value in plan["frame"])
            area = left + EDGE_NM, bottom + EDGE_NM, right - EDGE_NM, top - EDGE_NM
        board = Board(read_gds(inputs["gds"]), rules, dict(sorted(shapes.items())), area)
        diodes = Diodes(placement["instances"], masters, read_gds(inputs["cells"]), areas, tech)
        wanted = [net for net, pins in board.pins.items() if len(pins) > 1]
        found = route(board, wanted, tech, diodes, json.loads(inputs["lengths"].read_text(encoding="utf-8")))
        segments = {net: found.routes[net].listed(rules) if net in found.routes else [] for net in board.nets}
        placement["segments"] = segments
        write_gds(board.drawn(), outputs["gds"])
        outputs["placement"].write_text(json.dumps(placement, indent=0) + "\n", encoding="utf-8")
        outputs["diodes"].write_text(json.dumps({"nets": diodes.nets, "fill": diodes.fill}) + "\n", encoding="utf-8")
        lengths = [length for made in segments.values() for _, length, _ in made]
        return {
            "open_nets": len(found.open),
            "evictions": found.evictions,
            "respaced_nets": len(found.respaced),
            "long_nets": len(found.long),
            "diodes": len(diodes.nets),
            "wire_um": round(sum(lengths), 1),
            "vias": lengths.count(0),
        }
