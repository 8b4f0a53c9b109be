"""The cells of a process as the other steps want them: for Coriolis, KLayout, Yosys and simulators."""

import importlib
import json
import math
import re
from dataclasses import asdict, dataclass, field

from base.gds import write_gds
from base.steps import Step, StepError
from base.tools import run
from platforms.coriolis import coriolis_platform, standard_cells
from platforms.extraction import device_models, extraction_platform

from ..netlist.netlist import SUPPLIES
from ..timing import liberty

GRID_UM = 0.005  # on which pads are drawn
UNUSED = ("fill", "tie", "decap", "diode", "nsnrlatch")  # by synthesis
DIRECTIONS = {
    "vdd": "supply",
    "iovdd": "supply",
    "vss": "ground",
    "iovss": "ground",
    "q": "out",
    "nq": "out",
    "one": "out",
    "zero": "out",
    "co": "out",
    "s": "out",
}


@dataclass(frozen=True)
class LibraryParameters:
    """pdk: the process."""

    pdk: str = field(default="sky130")


class Library(Step):
    """PDKMaster's cells -> files. platform: the process's own description, whose text belongs to the result."""

    name = "library"
    inputs = {}
    outputs = {
        "coriolis": "coriolis",
        "gds": "cells.gds",
        "spice": "cells.spi",
        "drc": "process.drc",
        "lvs": "process.lvs",
        "areas": "areas.json",
        "liberty": "cells.lib",
        "verilog": "cells.v",
        "rules": "rules.json",
        "geometry": "geometry.json",
    }
    Parameters = LibraryParameters
    metrics = {"cells": ""}
    uses = (liberty,)
    shared = True
    tools = ("yosys", "python pdkmaster", "python c4m-flexcell", "python klayout")

    def run(self, inputs, outputs):
        known = coriolis_platform(self.parameters.pdk)
        package = importlib.import_module(known.package)
        description = importlib.import_module(f"{known.package}.pdkmaster")
        library = standard_cells(self.parameters.pdk)
        cells = [cell for cell in library.cells if cell.name != "Gallery"]
        outputs["geometry"].write_text(json.dumps(geometry(known), indent=1) + "\n")
        outputs["rules"].write_text(json.dumps(wiring_rules(known, description.tech.primitives), indent=1) + "\n")
        _coriolis(outputs["coriolis"], description, library, known)
        _klayout(outputs, description, package, library)
        areas = {cell.name: _area(cell) for cell in cells}
        outputs["areas"].write_text(json.dumps(areas, indent=1))
        ports = {cell.name: [port.name for port in cell.circuit.ports if port.name not in SUPPLIES] for cell in cells}
        models, cell_tech = device_models(self.parameters.pdk), extraction_platform(self.parameters.pdk)
        logic = [name for name in ports if not name.startswith(UNUSED)]
        found = liberty.functions(outputs["gds"], logic, models, cell_tech)
        outputs["liberty"].write_text(
            liberty.liberty(
                {name: cell for name, cell in found.items() if not cell[1] or cell[1].kind == "ff"}, ports, areas
            )
        )
        run(
            [
                "yosys",
                "-q",
                "-p",
                f"read_liberty {outputs['liberty']}; proc; write_verilog -noattr {outputs['verilog']}",
            ]
        )
        return {"cells": len(cells)}


def geometry(known):
    """What of the process decides where wires lie, and not how they behave: what layouts are made anew for."""
    made = asdict(known)
    del made["fill"], made["rail_um"], made["corners"]
    made["metals"] = [{"name": metal.name, "gds": metal.gds, "hole_um2": metal.min_hole_um2} for metal in known.metals]
    return made


def wiring_rules(known, primitives):
    """What PDKMaster's ``primitives`` say of the wires and cuts of ``known``, in um: a dict for JSON."""

    def enclosure(made):
        return [float(made.first), float(made.second)]

    wires = {wire.name: primitives[wire.name] for wire in known.metals}
    cuts = {cut.name: (primitives[cut.name], level) for level, cut in enumerate(known.vias)}
    return {
        "space_um": {name: float(wire.min_space) for name, wire in wires.items()},
        "metals": {
            name: {"width": float(wire.min_width), "space": float(wire.min_space), "area": float(wire.min_area or 0)}
            for name, wire in wires.items()
        },
        "vias": {
            name: {
                "below": enclosure(_of(cut.bottom, cut.min_bottom_enclosure, known.metals[level])),
                "above": enclosure(_of(cut.top, cut.min_top_enclosure, known.metals[level + 1])),
            }
            for name, (cut, level) in cuts.items()
        },
    }


def _of(layers, enclosures, wire):
    """The enclosure by ``wire``, one of ``layers``."""
    return next(made for layer, made in zip(layers, enclosures, strict=True) if layer.name == wire.name)


def _area(cell):
    box = cell.layout.boundary
    return round((box.right - box.left) * (box.top - box.bottom), 4)


def _coriolis(folder, description, library, known):
    from pdkmaster.io.coriolis import CoriolisExportSpec, FileExporter

    spec = CoriolisExportSpec(globalnets=("vdd", "vss"), net_direction_cb=lambda net: DIRECTIONS.get(net, "in"))
    export = FileExporter(tech=description.tech, gds_layers=description.gds_layers, spec=spec)
    package = folder / "exported"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text("")
    (package / "techno.py").write_text(export())
    (package / "StdCellLib.py").write_text(narrowed(export(library), known, description.tech.primitives))


def narrowed(text, known, primitives):
    """The export for Coriolis with the tracks of the highest wire as near as its pads may lie: PDKMaster keeps room
    there for cuts to the wire above, of which there are none (1.48 um instead of 0.68 um in SKY130)."""
    wire, cut = known.metals[-1], known.vias[-1]
    pad = cut.size_um + 2 * cut.enclosure_um
    numbers = [pad + float(primitives[wire.name].min_space), pad]
    begin = text.index(f"metal = tech.getLayer('{wire.name}')")
    head, gauge = text[:begin], text[begin:]
    around = f"u({cut.enclosure_um})"
    gauge, enclosures = re.subn(
        r"setEnclosures\(via, metal, .*\)", f"setEnclosures(via, metal, ({around}, {around}))", gauge, count=1
    )
    gauge, tracks = re.subn(
        r"(u\(0\.0\), )u\([\d.]+\), u\([\d.]+\)", rf"\1u({numbers[0]:g}), u({numbers[1]:g})", gauge, count=1
    )
    head, pads = with_short_pads(
        head, known.metals[-2].name, known.metals[-1].name, cut, float(primitives[known.metals[-2].name].min_area or 0)
    )
    if not enclosures or not tracks or not pads:
        raise StepError(f"library: PDKMaster's export has no gauge of {wire.name} that could be narrowed")
    return head + gauge


def with_short_pads(text, below, above, cut, area):
    """(the export, whether it has them) with the pads of the wire ``below`` at cuts to the highest, ``above``, only as
    long as the least ``area`` (um2) asks: PDKMaster's are 1.18 um long in SKY130, and two of them on one track are too
    near where they lie two tracks of the highest wire apart."""

    def shorter(match):
        long, wide = float(match[2]), float(match[3])
        least = area / (cut.size_um + 2 * wide) - cut.size_um
        needed = max(cut.enclosure_um, math.ceil(least / 2 / GRID_UM - 1e-9) * GRID_UM)
        return f"{match[1]}u({min(long, needed):g}), u({wide:g})"

    pattern = (
        rf"(via = tech\.getLayer\('{below}_{cut.name}_{above}'\)\n\s+setEnclosures\(via, metal, \()"
        r"u\(([\d.]+)\), u\(([\d.]+)\)"
    )
    return re.subn(pattern, shorter, text, count=1)


def _klayout(outputs, description, package, library):
    from pdkmaster.io.klayout import FileExporter, export2db
    from pdkmaster.io.spice import SpiceNetlistFactory

    devices = package.prims_spiceparams
    decks = FileExporter(tech=description.tech, gds_layers=description.gds_layers, prims_spiceparams=devices)()
    # pdkmaster-io-klayout 0.1.8 writes a constant that KLayout does not have, where a process spaces wide wires farther
    outputs["drc"].write_text(decks["drc"].replace(", Projection)", ", projection)"))
    outputs["lvs"].write_text(decks["lvs"])
    write_gds(
        export2db(library, gds_layers=description.gds_layers, cell_name=None, merge=False, add_pin_label=True),
        outputs["gds"],
    )
    netlists = SpiceNetlistFactory(params=devices)
    outputs["spice"].write_text(
        transistors("".join(netlists.export_circuit(cell.circuit) for cell in library.cells if cell.name != "Gallery"))
    )


def transistors(spice):
    """SPICE with every transistor as one: where a process has it as a subcircuit, KLayout would not know it."""
    cells = set(re.findall(r"(?im)^\.subckt (\S+)", spice))

    def device(match):
        return match[0] if match[2] in cells else f"M{match[1]}{match[2]}{match[3]}"

    return re.sub(r"(?m)^X(\S+ (?:\S+ ){4})(\w+)((?: \w+=\S+)+)$", device, spice)
