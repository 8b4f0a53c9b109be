"""The block's abstract, LEF: outline, pins, obstructions, and what each pin gathers and bears as an antenna."""

import json
from typing import Any

from talbot.base.steps import Files, Step, StepError
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.platforms.layout import layout_platform
from talbot.signoff.geometry.abstract import abstract, ports, read_back
from talbot.signoff.netlist.netlist import supplies


class Lef(Step[PdkParameters]):
    """Written from the GDS, then read by KLayout and compared with it."""

    name = "lef"
    inputs = {"gds": "fill.gds", "verilog": "stream_out.verilog", "plan": "stream_out.plan"}
    outputs = {"lef": "block.lef"}
    metrics = {"pins": ""}
    tools = ("python klayout",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        tech, directions = layout_platform(self.parameters.pdk), ports(inputs["verilog"].read_text(encoding="utf-8"))
        plan = json.loads(inputs["plan"].read_text(encoding="utf-8"))
        own = supplies(plan)
        outputs["lef"].write_text(abstract(inputs["gds"], directions, tech, own, framed=True), encoding="utf-8")
        if wrong := read_back(outputs["lef"], inputs["gds"], directions, tech, own):
            raise StepError(f"lef: read back, it differs from the GDS: {'; '.join(wrong)}")
        return {"pins": len(directions)}
