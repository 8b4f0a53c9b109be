"""Capacitance of the die's nets with coupling to their neighbours, extracted from the metal of the routes."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from talbot.base.gds import db
from talbot.platforms.extraction import ExtractionPlatform
from talbot.platforms.layout import LayoutPlatform
from talbot.platforms.wires import CORNERS
from talbot.signoff.parasitics.capacitance import capacitances
from talbot.signoff.parasitics.shapes import METAL_LEVEL, shapes

MOST = CORNERS[-1]  # the corner of wires with the most capacitance


def femtofarads(plan: Mapping[str, Any], tech: LayoutPlatform, devices: ExtractionPlatform) -> dict[str, float]:
    """Capacitance (fF) of each routed net of the plan to the substrate and to the other routes, at the corner MOST.

    Blocks, bars and pads are left out: branches and trunks are beside each other, hardly any beside these.
    """
    layout = db.Layout()
    layout.dbu = 0.001
    top = layout.create_cell("routes")
    at: dict[str, tuple[int, int, int]] = {}
    levels = {metal.gds: level for level, metal in enumerate(tech.metals, METAL_LEVEL)}
    for net, layer, datatype, *box in plan["shapes"]:
        if net in plan["routes"]:
            top.shapes(layout.layer(layer, datatype)).insert(db.Box(*box))
            if (layer, datatype) in levels:
                at[net] = levels[layer, datatype], (box[0] + box[2]) // 2, (box[1] + box[3]) // 2
    found = shapes(layout, top, tech, devices)
    (made,) = capacitances(found, [tech.wires[MOST]], np.zeros(found.net_count, np.bool_))
    totals = np.bincount(found.nets, made.own)
    return {net: float(totals[found.nets[found.at(*place)]]) for net, place in at.items()}
