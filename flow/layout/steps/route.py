"""Routing of all nets, with rules of space, area and antennas kept."""

import json
from dataclasses import dataclass
from typing import Any

from base.gds import read_gds, write_gds
from base.steps import Files, Step
from platforms.coriolis import coriolis_platform

from ..netlist.names import plain_names
from ..netlist.netlist import Netlist
from ..route.board import Board
from ..route.negotiate import route
from ..route.rules import RoutingRules


@dataclass(frozen=True)
class RouteParameters:
    """Parameters of `Route`.

    pdk: process. clock: name of the clock port.
    """

    pdk: str = "sky130"
    clock: str = "clk"


class Route(Step[RouteParameters]):
    """Negotiated congestion on a grid, from nothing.

    open_nets: that found no path. evictions: times that a net was rerouted for another. respaced_nets: rerouted because
    of a rule of space or width; antenna_jumpers: because of an antenna, with a jumper on the top layer at every gate.
    """

    name = "route"
    inputs = {
        "gds": "place.gds",
        "placement": "place.placement",
        "shapes": "place.shapes",
        "synthesized": "synthesis.netlist",
        "rules": "library.rules",
        "geometry": "library.geometry",
    }
    outputs = {"gds": "routed.gds", "placement": "placement.json"}
    metrics = {
        "open_nets": "",
        "evictions": "",
        "respaced_nets": "",
        "antenna_jumpers": "",
        "wire_um": "um",
        "vias": "",
    }
    tools = ("python klayout",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        p, tech = self.parameters, coriolis_platform(self.parameters.pdk)
        placement = json.loads(inputs["placement"].read_text())
        names = {plain: net for net, plain in plain_names(Netlist.read(inputs["synthesized"]), p.clock).items()}
        rules = RoutingRules.of(tech, json.loads(inputs["rules"].read_text()))
        board = Board(read_gds(inputs["gds"]), rules, json.loads(inputs["shapes"].read_text()))
        found = route(board, [net for net, pins in board.pins.items() if len(pins) > 1], tech)
        segments = {net: found.routes[net].listed(rules) if net in found.routes else [] for net in board.nets}
        placement["segments"] = {names.get(net, f"cts_{net}"): made for net, made in segments.items()}
        write_gds(board.drawn(), outputs["gds"])
        outputs["placement"].write_text(json.dumps(placement, indent=0) + "\n")
        lengths = [length for made in segments.values() for _, length, _ in made]
        return {
            "open_nets": len(found.open),
            "evictions": found.evictions,
            "respaced_nets": len(found.respaced),
            "antenna_jumpers": len(found.charged),
            "wire_um": round(sum(lengths), 1),
            "vias": lengths.count(0),
        }
