"""The loops of the router and of the extraction, compiled while other steps run."""

import json
from typing import Any

import numpy as np

from talbot.base.gds import db
from talbot.base.steps import Files, Step
from talbot.platforms.coriolis import coriolis_platform
from talbot.platforms.extraction import extraction_platform

from ..parasitics.capacitance import capacitances
from ..parasitics.extract import floating, with_fill_floating
from ..parasitics.shapes import METAL_LEVEL, shapes
from ..parasitics.trees import trees
from ..route.board import Board, NetShapes
from ..route.diodes import Diodes
from ..route.negotiate import route
from ..route.rules import RoutingRules
from .parameters import PdkParameters

SIDE_NM, PINS_NM = 30_000, (5_000, 25_000)  # of the layout; where its two pins are, across and up
PIN_NM = 1_500  # half of a pin's height


class Compiled(Step[PdkParameters]):
    """A wire is routed and extracted: Numba then has in its cache what `route` and `extraction` call.

    Without it they compile when nothing else can run. There is no result.
    """

    name = "compiled"
    inputs = {"rules": "library.rules"}
    shared = True
    tools = ("python klayout",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        tech, devices = coriolis_platform(self.parameters.pdk), extraction_platform(self.parameters.pdk)
        rules = RoutingRules.of(tech, json.loads(inputs["rules"].read_text(encoding="utf-8")))
        layer, layout = rules.layers[0], db.Layout()
        top, half = layout.create_cell("top"), layer.width // 2
        pins = [db.Box(at - half, at - PIN_NM, at + half, at + PIN_NM) for at in PINS_NM]
        for pin in pins:
            top.shapes(layout.layer(layer.layer, layer.datatype)).insert(pin)
        listed = [[[layer.name, *(nm / 1000 for nm in (p.left, p.bottom, p.right, p.top))]] for p in pins]
        wire: NetShapes = {"segments": [], "vias": [], "pins": listed}
        board = Board(layout, rules, {"wire": wire}, (0, 0, SIDE_NM, SIDE_NM))
        route(board, ["wire"], tech, Diodes([], {}, layout, {}, tech))
        drawn = board.drawn()
        found = shapes(drawn, drawn.top_cell(), tech, devices)
        ends = [(found.at(METAL_LEVEL, at, at), at, at) for at in PINS_NM]
        floats = floating(found, np.array([found.nets[ends[0][0]]]))
        wires = list(tech.wires.values())
        own = with_fill_floating(found, capacitances(found, wires, floats)[0], floats)
        trees(found, own, wires[0], [devices.vias[0].lef, *(via.lef for via in tech.vias)], ends, [0])
        return {}
