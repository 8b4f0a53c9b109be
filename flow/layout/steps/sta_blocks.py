"""Static timing at one corner with the blocks laid out before as their Liberty has them, as who has nothing else of
them would see it: beside `sta`, which sees all of their cells and wires."""

import json
from dataclasses import dataclass

from base.steps import Step
from platforms.coriolis import coriolis_platform

from ..netlist import netlist as netlist_module
from ..netlist.netlist import Netlist
from ..timing import opensta as opensta_module
from ..timing.opensta import opensta
from ..timing.parasitics import parasitics, spef
from . import sta
from .sta import SCRIPT, worst_slacks


@dataclass(frozen=True)
class StaBlocksParameters:
    """pdk: process. top: module. corner: its name. macros: modules laid out before."""

    pdk: str = "sky130"
    top: str = ""
    corner: str = ""
    macros: tuple = ()


class StaBlocks(Step):
    """blocks_wns_ns, blocks_whs_ns: worst slack of setup and hold."""

    inputs = {"netlist": "place_route.netlist", "placement": "reroute.placement", "sdc": "sdc"}
    outputs = {"report": "sta.txt"}
    Parameters = StaBlocksParameters
    metrics = {"blocks_wns_ns": "ns", "blocks_whs_ns": "ns"}
    uses = (netlist_module, opensta_module, sta)
    tools = ("sta",)

    def __init__(self, parameters):
        super().__init__(parameters)
        corner = parameters.corner
        self.name = f"sta_blocks_{corner}"
        self.inputs = (
            self.inputs
            | {"liberty": f"timing.{corner}"}
            | {module: f"macro.{module}.{corner}" for module in parameters.macros}
        )

    def run(self, inputs, outputs):
        p, folder = self.parameters, outputs["report"].parent
        known, netlist = coriolis_platform(p.pdk), Netlist.read(inputs["netlist"])
        segments = json.loads(inputs["placement"].read_text())["segments"]
        there = {net for instance in netlist.instances for net in instance.pins.values()}
        files = {name: folder / f"{name}.log" for name in ("verilog", "spef", "sdf")}
        files["verilog"].write_text(netlist.verilog())
        files["spef"].write_text(
            spef(netlist, {net: parasitics(parts, known) for net, parts in segments.items() if net in there})
        )
        libraries = "\nread_liberty ".join(str(inputs[name]) for name in ("liberty", *p.macros))
        said = opensta(folder / "sta.log", SCRIPT.format(top=p.top, liberty=libraries, sdc=inputs["sdc"], **files))
        outputs["report"].write_text(said)
        worst = worst_slacks(said, self.name)
        return {"blocks_wns_ns": round(worst["setup"], 4), "blocks_whs_ns": round(worst["hold"], 4)}
