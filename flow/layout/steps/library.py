"""The cells of a process as the other steps need them: for OpenROAD, KLayout, Yosys and simulators."""

import json
from typing import Any

from talbot.base.liberty.verilog import write_models
from talbot.base.steps import Files, Step
from talbot.cells.standard import standard_cells
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.flow.layout.timing import liberty
from talbot.platforms.decks import export_decks
from talbot.platforms.extraction import device_models, extraction_platform
from talbot.platforms.layout import layout_platform
from talbot.platforms.patience import imported
from talbot.platforms.place_and_route import place_and_route
from talbot.signoff import pdkmaster
from talbot.signoff.geometry import process_lef
from talbot.signoff.netlist.netlist import DIODE, SUPPLIES

UNUSED = ("fill", "tie", "decap", "diode", "nsnrlatch")  # by synthesis


class Library(Step[PdkParameters]):
    """PDKMaster's cells, exported; Liberty with areas and functions from the layouts."""

    name = "library"
    outputs = {
        "gds": "cells.gds",
        "spice": "cells.spi",
        "drc": "process.drc",
        "lvs": "process.lvs",
        "areas": "areas.json",
        "liberty": "cells.lib",
        "verilog": "cells.v",
        "rules": "rules.json",
        "tech_lef": "tech.lef",
        "cell_lef": "cells.lef",
    }
    metrics = {"cells": ""}
    shared = True
    tools = ("yosys", "python pdkmaster", "python c4m-flexcell", "python klayout")

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        pdk = self.parameters.pdk
        tech = layout_platform(pdk)
        models = imported(tech.package).prims_spiceparams
        description = imported(f"{tech.package}.pdkmaster")
        standard = standard_cells(pdk, outputs["gds"].parents[1] / "drawn")
        library = standard.library
        cells = [cell for cell in library.cells if cell.name != "Gallery"]
        rules = pdkmaster.routing_rules(tech, description.tech.primitives)
        outputs["rules"].write_text(json.dumps(rules, indent=1) + "\n", encoding="utf-8")
        for name, deck in export_decks(tech).items():
            outputs[name].write_text(deck, encoding="utf-8")
        standard.write_gds(outputs["gds"])
        outputs["spice"].write_text(pdkmaster.export_spice(cells, models), encoding="utf-8")
        areas = {cell.name: pdkmaster.cell_area(cell) for cell in cells}
        outputs["areas"].write_text(json.dumps(areas, indent=1), encoding="utf-8")
        every = {cell.name: [port.name for port in cell.circuit.ports] for cell in cells}
        tools, devices = place_and_route(pdk), extraction_platform(pdk)
        outputs["tech_lef"].write_text(process_lef.technology(rules, tech, tools), encoding="utf-8")
        outputs["cell_lef"].write_text(
            process_lef.library(outputs["gds"], every, tech, devices, tools), encoding="utf-8"
        )
        ports = {cell: [name for name in names if name not in SUPPLIES] for cell, names in every.items()}
        logic = [name for name in ports if not name.startswith(UNUSED)]
        found = liberty.functions(outputs["gds"], logic, device_models(pdk), devices)
        chosen = {name: cell for name, cell in found.items() if not cell.storage or cell.storage.kind != "latch"}
        outputs["liberty"].write_text(liberty.liberty(chosen, ports, areas), encoding="utf-8")
        write_models(outputs["liberty"], outputs["verilog"])
        with outputs["verilog"].open("a", encoding="utf-8") as file:
            file.write(f"\nmodule {DIODE} (input i);\nendmodule\n")
        return {"cells": len(cells)}
