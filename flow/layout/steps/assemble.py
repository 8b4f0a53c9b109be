"""The routed design and its macros as one: for the steps that look at cells and metal."""

import json
from dataclasses import dataclass
from typing import Any

from talbot.base.steps import Files, Step
from talbot.platforms.coriolis import coriolis_platform

from ..geometry.macro_cells import insert_macros
from ..netlist.flatten import flattened, merged_placement
from ..netlist.netlist import Netlist, is_register

PARTS = "netlist", "placement", "spice", "gds"  # of a macro


@dataclass(frozen=True)
class AssembleParameters:
    """Parameters of `Assemble`. pdk: process. macros: modules laid out before."""

    pdk: str = "sky130"
    macros: tuple[str, ...] = ()


class Assemble(Step[AssembleParameters]):
    """The macros' GDS in place of their black boxes; netlist and placement without hierarchy; netlists of transistors.

    cells: all but those that fill gaps, clock buffers too.
    """

    name = "assemble"
    inputs = {
        "netlist": "repair.netlist",
        "placement": "route.placement",
        "floorplan": "floorplan.floorplan",
        "cells": "library.spice",
        "gds": "route.gds",
        "areas": "library.areas",
    }
    outputs = {"gds": "assembled.gds", "netlist": "netlist.json", "placement": "placement.json", "spice": "parts.spi"}
    metrics = {"cells": "", "flip_flops": "", "cell_area_um2": "um2", "wire_um": "um"}
    tools = ("python klayout",)

    def __init__(self, parameters: AssembleParameters) -> None:
        super().__init__(parameters)
        parts = {f"{module}.{part}": f"macro.{module}.{part}" for module in parameters.macros for part in PARTS}
        self.inputs = {**self.inputs, **parts}

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        modules, tech = self.parameters.macros, coriolis_platform(self.parameters.pdk)
        netlist, placement = (
            Netlist.read(inputs["netlist"]),
            json.loads(inputs["placement"].read_text(encoding="utf-8")),
        )
        placed = json.loads(inputs["floorplan"].read_text(encoding="utf-8"))["macros"]
        netlists = {module: Netlist.read(inputs[f"{module}.netlist"]) for module in modules}
        placements = {
            module: json.loads(inputs[f"{module}.placement"].read_text(encoding="utf-8")) for module in modules
        }
        flat = flattened(netlist, {macro["instance"]: netlists[macro["cell"]] for macro in placed})
        flat.write(outputs["netlist"])
        inside = {macro["instance"]: placements[macro["cell"]] for macro in placed}
        places = {macro["instance"]: (macro["x_um"], macro["y_um"]) for macro in placed}
        whole = merged_placement(netlist, placement, inside, places)
        outputs["placement"].write_text(json.dumps(whole, indent=0) + "\n", encoding="utf-8")
        insert_macros(inputs["gds"], outputs["gds"], [(inputs[f"{m['cell']}.gds"], m) for m in placed], tech)
        cells = inputs["cells"].read_text(encoding="utf-8")
        own = [inputs[f"{module}.spice"].read_text(encoding="utf-8").removesuffix(cells) for module in modules]
        outputs["spice"].write_text("\n".join([*own, cells]), encoding="utf-8")
        areas = json.loads(inputs["areas"].read_text(encoding="utf-8"))
        logic = [instance.cell for instance in flat.instances if instance.pins]
        return {
            "cells": len(logic),
            "flip_flops": sum(map(is_register, logic)),
            "cell_area_um2": round(sum(areas[cell] for cell in logic), 2),
            "wire_um": round(sum(length for net in whole["segments"].values() for _, length, _ in net), 1),
        }
