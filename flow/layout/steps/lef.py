"""The block's abstract, LEF: outline, pins, obstructions, and what each pin gathers and bears as an antenna."""

from dataclasses import dataclass

from base.steps import Step, StepError
from platforms.coriolis import coriolis_platform

from ..geometry import abstract as abstract_module
from ..geometry import macro
from ..geometry.abstract import abstract, ports, read_back


@dataclass(frozen=True)
class LefParameters:
    """pdk: process."""

    pdk: str = "sky130"


class Lef(Step):
    """Made from the GDS, then read by KLayout and held against it."""

    name = "lef"
    inputs = {"gds": "fill.gds", "verilog": "stream_out.verilog"}
    outputs = {"lef": "block.lef"}
    Parameters = LefParameters
    metrics = {"pins": ""}
    uses = (abstract_module, macro)
    tools = ("python klayout",)

    def run(self, inputs, outputs):
        pdk = self.parameters.pdk
        known, directions = coriolis_platform(pdk), ports(inputs["verilog"].read_text())
        outputs["lef"].write_text(abstract(inputs["gds"], directions, known))
        if wrong := read_back(outputs["lef"], inputs["gds"], directions, known):
            raise StepError(f"lef: read back, it differs from the GDS: {'; '.join(wrong)}")
        return {"pins": len(directions)}
