"""Rip-up and reroute of nets that are open, too near to others or have an antenna."""

import json
from dataclasses import dataclass
from typing import Any

from base.gds import read_gds, write_gds
from base.steps import Files, Step
from models.parameters import check_int
from platforms.coriolis import coriolis_platform

from ..coriolis.log import open_nets
from ..netlist.names import plain_names
from ..netlist.netlist import Netlist
from ..reroute.board import Board
from ..reroute.negotiate import reroute
from ..reroute.rules import RoutingRules

COUNTS = ("open_nets", "rerouted_nets", "antenna_jumpers", "respaced_nets", "evicted_nets")


@dataclass(frozen=True)
class RerouteParameters:
    """Parameters of `Reroute`.

    pdk: process. clock: name of the clock port. most: open nets, with more the layout is given up.
    """

    pdk: str = "sky130"
    clock: str = "clk"
    most: int = 60

    def __post_init__(self) -> None:
        check_int("most", self.most, 0, 10_000)


class Reroute(Step[RerouteParameters]):
    """Rip-up and reroute with negotiated congestion.

    open_nets: still open. rerouted_nets: rerouted because they were open; antenna_jumpers: because of an antenna, with
    a jumper on the top layer in front of every gate; respaced_nets: because another net was too near; evicted_nets:
    because they were in the way, those of the clock tree, too.
    """

    name = "reroute"
    inputs = {
        "gds": "place_route.gds",
        "placement": "place_route.placement",
        "shapes": "place_route.shapes",
        "log": "place_route.log",
        "synthesized": "synthesis.netlist",
        "rules": "library.rules",
        "geometry": "library.geometry",
    }
    outputs = {"gds": "rerouted.gds", "placement": "placement.json"}
    metrics = dict.fromkeys(COUNTS, "") | {"wire_um": "um"}
    tools = ("python klayout",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        p, tech = self.parameters, coriolis_platform(self.parameters.pdk)
        placement = json.loads(inputs["placement"].read_text())
        names = {plain: net for net, plain in plain_names(Netlist.read(inputs["synthesized"]), p.clock).items()}
        layout, left = read_gds(inputs["gds"]), open_nets(inputs["log"].read_text())
        shapes = json.loads(inputs["shapes"].read_text())
        # Of a shape that two nets have drawn, the open one's is the short: it claims last
        order = [net for net in shapes if net not in left] + left
        rules = RoutingRules.of(tech, json.loads(inputs["rules"].read_text()))
        board = Board(layout, rules, {net: shapes[net] for net in order})
        found = reroute(board, {net: shapes[net]["pins"] for net in order}, left, p.most, inputs["gds"], tech)
        for net, route in found.routes.items():
            placement["segments"][names.get(net, f"cts_{net}")] = route.listed(rules)
        write_gds(board.drawn(), outputs["gds"])
        outputs["placement"].write_text(json.dumps(placement, indent=0) + "\n")
        rerouted = set(found.routes) & set(left)
        jumped = set(found.routes) & found.charged - rerouted
        respaced = found.respaced - rerouted - jumped
        evicted = set(found.routes) - rerouted - jumped - respaced
        counts = zip(COUNTS, map(len, (found.open, rerouted, jumped, respaced, evicted)), strict=True)
        length = sum(length for net in placement["segments"].values() for _, length, _ in net)
        return dict(counts) | {"wire_um": round(length, 1)}
