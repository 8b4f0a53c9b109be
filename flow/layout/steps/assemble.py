"""The routed design and the blocks that were laid out before, put together for all that looks at cells and wires."""

import json
from dataclasses import dataclass

from base.gds import write_gds
from base.steps import Step
from platforms.coriolis import coriolis_platform

from ..geometry import assembly as assembly_module
from ..geometry.assembly import flat, together
from ..netlist import netlist as netlist_module
from ..netlist.netlist import Netlist, is_register
from .place_route import BLOCK

PARTS = "netlist", "placement", "spice", "gds"  # of a block


@dataclass(frozen=True)
class AssembleParameters:
    """pdk: process. macros: modules laid out before."""

    pdk: str = "sky130"
    macros: tuple = ()


class Assemble(Step):
    """The blocks' GDS in place of what stood for them; netlist and placement without hierarchy; netlists of
    transistors, a block's as it was compared itself. The cells are all but those that fill gaps, clocks' buffers too.
    """

    name = "assemble"
    inputs = {
        "netlist": "place_route.netlist",
        "placement": "reroute.placement",
        "floorplan": "floorplan.floorplan",
        "cells": "library.spice",
        "gds": "reroute.gds",
        "areas": "library.areas",
    }
    outputs = {"gds": "assembled.gds", "netlist": "netlist.json", "placement": "placement.json", "spice": "parts.spi"}
    Parameters = AssembleParameters
    metrics = {"cells": "", "flip_flops": "", "cell_area_um2": "um2", "wire_um": "um"}
    uses = (assembly_module, netlist_module)
    tools = ("python klayout",)

    def __init__(self, parameters):
        super().__init__(parameters)
        self.inputs = self.inputs | {
            f"{module}.{part}": f"macro.{module}.{part}" for module in parameters.macros for part in PARTS
        }

    def run(self, inputs, outputs):
        netlist, placement = Netlist.read(inputs["netlist"]), json.loads(inputs["placement"].read_text())
        placed = json.loads(inputs["floorplan"].read_text())["macros"]
        netlists = {module: Netlist.read(inputs[f"{module}.netlist"]) for module in self.parameters.macros}
        placements = {
            module: json.loads(inputs[f"{module}.placement"].read_text()) for module in self.parameters.macros
        }
        blocks = {block["instance"]: (netlists[block["cell"]], placements[block["cell"]]) for block in placed}
        made = flat(netlist, {name: own for name, (own, _) in blocks.items()})
        made.write(outputs["netlist"])
        whole = together(netlist, placement, blocks, {b["instance"]: (b["x_um"], b["y_um"]) for b in placed})
        outputs["placement"].write_text(json.dumps(whole, indent=0) + "\n")
        put_in(
            inputs["gds"],
            outputs["gds"],
            [(inputs[f"{block['cell']}.gds"], block) for block in placed],
            coriolis_platform(self.parameters.pdk),
        )
        cells = inputs["cells"].read_text()
        own = [inputs[f"{module}.spice"].read_text().removesuffix(cells) for module in self.parameters.macros]
        outputs["spice"].write_text("\n".join([*own, cells]))
        areas = json.loads(inputs["areas"].read_text())
        logic = [instance.cell for instance in made.instances if instance.pins]
        return {
            "cells": len(logic),
            "flip_flops": sum(map(is_register, logic)),
            "cell_area_um2": round(sum(areas[cell] for cell in logic), 2),
            "wire_um": round(sum(wire[1] for net in whole["segments"].values() for wire in net), 1),
        }


def put_in(source, target, blocks, known):
    """Write ``source`` as ``target`` with the blocks in place of the cells that stood for them, whose wires to the pins
    go to the top cell. blocks: pairs (GDS, entry in the floorplan), in the floorplan's order."""
    import klayout.db as db

    layout, options = db.Layout(), db.LoadLayoutOptions()
    layout.read(str(source))
    top = layout.top_cell()
    options.cell_conflict_resolution = db.LoadLayoutOptions.CellConflictResolution.SkipNewCell  # of the library
    for number, (path, block) in enumerate(blocks):
        stood, (left, bottom, *_) = layout.cell(f"{BLOCK}{number}"), block["outer"]
        for numbers in [part.gds for part in (*known.metals, *known.vias)]:
            layer = layout.layer(*numbers)
            top.shapes(layer).insert(
                db.Region(stood.shapes(layer)).moved(round(left / layout.dbu), round(bottom / layout.dbu))
            )
        layout.prune_cell(stood.cell_index(), -1)
        if layout.cell(block["cell"]) is None:
            layout.read(str(path), options)
        top.insert(db.DCellInstArray(layout.cell(block["cell"]).cell_index(), db.DTrans(block["x_um"], block["y_um"])))
    write_gds(layout, target)
