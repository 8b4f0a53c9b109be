"""Connectivity of the die's GDS, compared with the nets of the plan."""

import json
from collections.abc import Mapping
from typing import Any

from talbot.base.steps import Files, Step
from talbot.flow.layout.sensor import connectivity
from talbot.flow.layout.sensor.decoupling import CELL
from talbot.flow.layout.sensor.ring import Frame
from talbot.flow.layout.sensor.steps.die_gds import corners, turned
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.platforms.die import top_metal
from talbot.platforms.layout import layout_platform
from talbot.platforms.pads import pad_process


class DieConnectivity(Step[PdkParameters]):
    """Every net of the plan, extracted from the metal of the finished GDS and of the blocks in it.

    lvs_match: of the pins of blocks and pads; the insides of the blocks have their own LVS.
    """

    name = "die_connectivity"
    inputs = {"gds": "die_gds.gds", "plan": "die_plan.plan"}
    outputs = {"report": "connectivity.json"}
    metrics = {"open_nets": "", "shorts": "", "lvs_match": ""}
    tools = ("python klayout",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        plan, pdk = json.loads(inputs["plan"].read_text(encoding="utf-8")), self.parameters.pdk
        cells = {block["cell"]: name for name, block in plan["blocks"].items()} | {CELL: ""}
        ring = self.ring(plan) if plan["ring"] else {}
        tech, plate = layout_platform(pdk), pad_process(pdk).capacitor.plate
        found = connectivity.nets(inputs["gds"], cells, ring, tech, top_metal(pdk), plate)
        opens, shorts = connectivity.compare(found, plan["nets"])
        outputs["report"].write_text(json.dumps({"open": opens, "short": shorts}, indent=1) + "\n", encoding="utf-8")
        return {"open_nets": len(opens), "shorts": len(shorts), "lvs_match": not opens and not shorts}

    def ring(self, plan: Mapping[str, Any]) -> dict[tuple[str, int, int], str]:
        """(cell, x, y) of each pad of a ring -> its name, '' for fillers and corners."""
        frame = Frame(**plan["frame"])
        at = [
            (place["cell"], place["nets"] and place["name"], turned(frame, place["side"], place["at"]).disp)
            for place in plan["ring"]
        ]
        at += [(plan["corner"], "", trans.disp) for trans in corners(frame)]
        return {(cell, disp.x, disp.y): name or "" for cell, name, disp in at}
