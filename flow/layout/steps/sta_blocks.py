"""Static timing of a design with macros, these by their Liberty; `sta` times all of their cells and nets."""

from dataclasses import dataclass
from typing import Any

from talbot.base.steps import Files

from ..netlist.netlist import Netlist
from ..timing.opensta import opensta, worst_slack
from .corner import CornerStep
from .sta import SCRIPT


@dataclass(frozen=True)
class StaBlocksParameters:
    """What is timed. pdk: process. top: module. corner: its name. macros: their modules."""

    pdk: str = "sky130"
    top: str = ""
    corner: str = ""
    macros: tuple[str, ...] = ()


class StaBlocks(CornerStep[StaBlocksParameters]):
    """Worst slack of setup (blocks_wns_ns) and hold (blocks_whs_ns)."""

    name = "sta_blocks_{corner}"
    inputs = {"netlist": "repair.netlist", "spef": "extraction_blocks.{wires}", "sdc": "sdc"}
    inputs |= {"liberty": "timing.{corner}"}
    outputs = {"report": "sta.txt"}
    metrics = {"blocks_wns_ns": "ns", "blocks_whs_ns": "ns"}
    tools = ("sta",)

    def __init__(self, parameters: StaBlocksParameters) -> None:
        super().__init__(parameters)
        macros = {module: f"macro.{module}.{parameters.corner}" for module in parameters.macros}
        self.inputs = {**self.inputs, **macros}

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        p, folder, netlist = self.parameters, outputs["report"].parent, Netlist.read(inputs["netlist"])
        files = {name: folder / f"{name}.log" for name in ("verilog", "sdf")} | {"spef": inputs["spef"]}
        files["verilog"].write_text(netlist.verilog(), encoding="utf-8")
        libraries = "\nread_liberty ".join(str(inputs[name]) for name in ("liberty", *p.macros))
        script = SCRIPT.format(top=p.top, liberty=libraries, sdc=inputs["sdc"], **files)
        report = opensta(folder / "sta.log", script)
        outputs["report"].write_text(report, encoding="utf-8")
        setup, hold = (round(worst_slack(report, kind), 4) for kind in ("setup", "hold"))
        return {"blocks_wns_ns": setup, "blocks_whs_ns": hold}
