"""The pads of the die: their cells, the rules that these keep, and their layout against their netlists."""

import importlib
import json
from typing import Any

from talbot.base.gds import write_gds
from talbot.base.steps import Files, Step, StepError
from talbot.flow.layout.sensor import pads
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.platforms.layout import layout_platform
from talbot.platforms.pads import pad_process
from talbot.platforms.pixel import pixel_process
from talbot.signoff.geometry.decks import check_rules, hole_rules, run_deck, via_rules
from talbot.signoff.pdkmaster import export_spice


class DiePads(Step[PdkParameters]):
    """The pads' GDS, netlists, and pins (JSON: see `talbot.flow.layout.sensor.ring`)."""

    name = "die_pads"
    outputs = {"gds": "pads.gds", "spice": "pads.spi", "pins": "pins.json"}
    metrics = {"pad_cells": ""}
    shared = True
    tools = ("python pdkmaster", "python c4m-flexio", "python klayout")

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        process, pixel = pad_process(self.parameters.pdk), pixel_process(self.parameters.pdk)
        library, gates = pads.library(process)
        layout = pads.layout(library, process, pixel)
        found = {name: pads.pins(layout.cell(name), pixel) for name in process.cells}
        outputs["pins"].write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
        pads.row(layout, process)
        write_gds(layout, outputs["gds"])
        devices = importlib.import_module(process.package).prims_spiceparams
        cells = [cell for cell in (*library.cells, *gates.cells) if cell.name != "Gallery"]
        outputs["spice"].write_text(pads.joined(export_spice(cells, devices), process), encoding="utf-8")
        return {"pad_cells": len(found)}


class DiePadsDrc(Step[PdkParameters]):
    """Every rule over a row of all pads, fillers and corners: PDKMaster's deck, and the process's rules of pads."""

    name = "die_pads_drc"
    inputs = {"gds": "die_pads.gds", "deck": "library.drc"}
    outputs = {"report": "drc.lyrdb", "summary": "drc.json", "deep": "deep.drc", "flat": "flat.drc"}
    metrics = {"pad_drc_violations": ""}
    tools = ("klayout",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        tech, process = layout_platform(self.parameters.pdk), pad_process(self.parameters.pdk)
        flat = *hole_rules(tech), process.masks.read_text(encoding="utf-8")
        deck = inputs["deck"].read_text(encoding="utf-8")
        found = check_rules(deck, via_rules(tech), flat, inputs["gds"], outputs)
        return {"pad_drc_violations": sum(found.values())}


class DiePadsLvs(Step[PdkParameters]):
    """Every pad's transistors, diodes and resistors against its netlist; the pads that do not match, by name."""

    name = "die_pads_lvs"
    inputs = {"gds": "die_pads.gds", "spice": "die_pads.spice", "deck": "library.lvs"}
    outputs = {"verdicts": "lvs.json", "reports": "reports"}
    metrics = {"pads_unmatched": ""}
    tools = ("klayout",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        process = pad_process(self.parameters.pdk)
        outputs["reports"].mkdir()
        found = {}
        for cell in (*process.signals.values(), *process.supplies.values()):
            report = outputs["reports"] / f"{cell}.lvsdb"
            paths = {"SOURCE_FILE": inputs["gds"], "REPORT_FILE": report, "SPICE_FILE": inputs["spice"]}
            files = {name: path.resolve() for name, path in paths.items()}
            _, output = run_deck(inputs["deck"], report, {}, CELL_NAME=cell, **files)
            if ("LVS OK" in output) == ("LVS Failed" in output):
                raise StepError(f"{self.name}: KLayout gave no verdict on {cell}: {output.strip().splitlines()[-1:]}")
            found[cell] = "LVS OK" in output
        outputs["verdicts"].write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
        return {"pads_unmatched": sum(not match for match in found.values())}
