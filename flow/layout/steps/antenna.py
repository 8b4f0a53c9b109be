"""Antennas of a layout, layer by layer."""

import json
from typing import Any

from talbot.base.gds import read_gds
from talbot.base.steps import Files, Step
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.platforms.layout import LayoutPlatform, layout_platform
from talbot.signoff.geometry.antenna import violations


class Antenna(Step[PdkParameters]):
    """Every layer in turn, on the connections that exist by then."""

    name = "antenna"
    inputs = {"gds": "fill.gds"}
    outputs = {"summary": "antenna.json"}
    metrics = {"antenna_violations": ""}
    tools = ("python klayout",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        tech, layout = self.tech(), read_gds(inputs["gds"])
        found = {}
        for level, bad in violations(layout, layout.top_cell(), tech).items():
            boxes = {str(polygon.bbox().to_dtype(layout.dbu)) for polygon in bad.each()}
            found[tech.metals[level].name] = sorted(boxes)
        outputs["summary"].write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
        return {"antenna_violations": sum(map(len, found.values()))}

    def tech(self) -> LayoutPlatform:
        """The technology with the layers to check."""
        return layout_platform(self.parameters.pdk)
