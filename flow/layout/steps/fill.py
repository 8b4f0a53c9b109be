"""Fill of every layer, to the densities that the process asks for."""

import json
from typing import Any

from talbot.base.gds import read_gds, write_gds
from talbot.base.steps import Files, Step
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.flow.layout.steps.routed import PREFIX, of_routed
from talbot.platforms.layout import layout_platform
from talbot.signoff.geometry.fill import densities, fill, fill_cells


class Fill(Step[PdkParameters]):
    """Shapes on all metals but the lowest until a layer has its density or no room; diffusion and li in filler cells.

    density: share of every layer that is covered in its densest window. density_violations: layers with more than the
    process allows in some window. thin_layers: those with less. Shapes keep the process's clearance to other metal;
    `extraction` counts what they add to the nets.
    """

    name = "fill"
    inputs = {"gds": "stream_out.gds"}
    outputs = {"gds": "layout.gds", "summary": "fill.json"}
    metrics = {"shapes": "", "density": "", "density_violations": "", "thin_layers": ""}
    tools = ("python klayout",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        tech, layout = layout_platform(self.parameters.pdk), read_gds(inputs["gds"])
        top, rules = layout.top_cell(), tech.fill
        masks = {"diffusion": [tech.active, *([tech.tap] if tech.tap else [])]} | {m.name: [m.gds] for m in tech.metals}
        before = {name: densities(layout, top, of_layer, rules.window_um) for name, of_layer in masks.items()}
        if tech.dummies:
            fill_cells(layout, tech.fill_cells, tech.dummies)
        shapes = sum(fill(layout, top, metal, rules) for metal in tech.metals[1:])
        after = {name: densities(layout, top, of_layer, rules.window_um) for name, of_layer in masks.items()}
        write_gds(layout, outputs["gds"])
        outputs["summary"].write_text(json.dumps({"before": before, "after": after}, indent=1) + "\n", encoding="utf-8")
        return {
            "shapes": shapes,
            "density": {name: most for name, (_, most) in after.items()},
            "density_violations": sum(most > rules.density_most for _, most in after.values()),
            "thin_layers": [name for name, (least, _) in after.items() if least < rules.density_least],
        }


class RoutedFill(Fill):
    """The same of the routed layout."""

    name = f"{PREFIX}{Fill.name}"
    inputs = of_routed(Fill.inputs)
