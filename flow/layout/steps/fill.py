"""Metal fill of every layer except the lowest."""

import json
from typing import Any

from talbot.base.gds import read_gds, write_gds
from talbot.base.steps import Files, Step
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.platforms.layout import layout_platform
from talbot.signoff.geometry.fill import fill, peak_density


class Fill(Step[PdkParameters]):
    """The largest squares first, until a layer has its density or no room.

    before, after: density of every layer in its densest window. density_violations: layers with more than the process
    allows. It keeps the process's clearance to other metal; `extraction` counts what it adds to the nets.
    """

    name = "fill"
    inputs = {"gds": "stream_out.gds"}
    outputs = {"gds": "layout.gds", "summary": "fill.json"}
    metrics = {"squares": "", "before": "", "after": "", "density_violations": ""}
    tools = ("python klayout",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        tech, layout = layout_platform(self.parameters.pdk), read_gds(inputs["gds"])
        top = layout.top_cell()
        before = {metal.name: peak_density(layout, top, metal, tech.fill) for metal in tech.metals}
        squares = sum(fill(layout, top, metal, tech.fill) for metal in tech.metals[1:])
        after = {metal.name: peak_density(layout, top, metal, tech.fill) for metal in tech.metals}
        write_gds(layout, outputs["gds"])
        dense = {name: density for name, density in after.items() if density > tech.fill.density_most}
        summary = {"before": before, "after": after, "too dense": dense}
        outputs["summary"].write_text(json.dumps(summary, indent=1) + "\n", encoding="utf-8")
        return {"squares": squares, "before": before, "after": after, "density_violations": len(dense)}
