"""Cells sized and buffered for their wires, in the empty places of a placement."""

import json
from dataclasses import dataclass, field
from typing import Any

from base.gds import db, read_gds, write_gds
from base.steps import Files, Step
from models.parameters import check_real
from platforms.coriolis import CoriolisPlatform, coriolis_platform
from platforms.wires import wire_corner

from ..netlist.netlist import Netlist
from ..netlist.placed import TURNS
from ..repair.drive import Drives
from ..repair.repair import Plan, clock_nets, repaired
from ..repair.rows import free_rows
from ..repair.wires import femtofarad_um


@dataclass(frozen=True)
class RepairParameters:
    """Parameters of `Repair`.

    pdk: process. corner: of the cells' timing that decides. slew_ns: that every driver is to keep. load_pf: of an
    output.
    """

    pdk: str = "sky130"
    corner: str = ""
    slew_ns: float = field(default=0.5, metadata={"unit": "ns"})
    load_pf: float = field(default=0.0, metadata={"unit": "pF"})

    def __post_init__(self) -> None:
        check_real("slew_ns", self.slew_ns, 0.05, 10)
        check_real("load_pf", self.load_pf, 0, 1000)


class Repair(Step[RepairParameters]):
    """Drivers that are too weak at the slowest corner for the wires that a placement implies get larger or a buffer.

    Without timing nothing changes but that all masks of the cells are drawn, which Coriolis does not know.
    """

    name = "repair"
    inputs = {
        "gds": "place.gds",
        "netlist": "place.netlist",
        "placement": "place.placement",
        "floorplan": "floorplan.floorplan",
        "masks": "library.gds",
        "areas": "library.areas",
    }
    outputs = {"gds": "repaired.gds", "netlist": "netlist.json", "placement": "placement.json"}
    metrics = {"sized": "", "buffers": "", "cells": "", "cell_area_um2": "um2"}
    tools = ("python klayout",)

    def __init__(self, parameters: RepairParameters) -> None:
        super().__init__(parameters)
        if parameters.corner:
            self.inputs = {**self.inputs, "liberty": f"timing.{parameters.corner}"}

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        p, tech = self.parameters, coriolis_platform(self.parameters.pdk)
        netlist, placement = Netlist.read(inputs["netlist"]), json.loads(inputs["placement"].read_text())
        areas = json.loads(inputs["areas"].read_text())
        layout, counts = read_gds(inputs["gds"]), {"sized": 0, "buffers": 0}
        if p.corner:
            plan = self.plan(netlist, placement, json.loads(inputs["floorplan"].read_text()), areas, tech)
            counts = repaired(plan, Drives.of(inputs["liberty"], p.slew_ns), clock_nets(netlist))
            netlist, placement["instances"] = plan.listed(netlist, placement["instances"], tech.fill_cells)
        draw(layout, read_gds(inputs["masks"]), areas, placement["instances"])
        write_gds(layout, outputs["gds"])
        netlist.write(outputs["netlist"])
        outputs["placement"].write_text(json.dumps(placement, indent=0) + "\n")
        cells = [instance.cell for instance in netlist.instances if instance.pins]
        return counts | {"cells": len(cells), "cell_area_um2": round(sum(areas.get(cell, 0) for cell in cells), 2)}

    def plan(
        self, netlist: Netlist, placement: dict[str, Any], floorplan: dict[str, Any], areas: dict[str, float],
        tech: CoriolisPlatform,
    ) -> Plan:  # fmt: skip
        """The placement as `repaired` takes it."""
        widths = {cell: round(area / tech.row_um, 4) for cell, area in areas.items()}
        width, height = floorplan["width_um"], floorplan["height_um"]
        sides = {"west": lambda at: (0, at), "east": lambda at: (width, at)}
        sides |= {"south": lambda at: (at, 0), "north": lambda at: (at, height)}
        placed = zip(netlist.instances, placement["instances"], strict=True)
        working = [(instance, place) for instance, (_, _, *place) in placed if instance.pins]
        outputs = [net for port in netlist.ports if port.direction == "output" for net in port.bits()]
        return Plan(
            instances={instance.name: instance for instance, _ in working},
            places={instance.name: tuple(place) for instance, place in working},
            widths=widths,
            row_um=tech.row_um,
            rows=free_rows(placement["instances"], widths, tech.fill_cells, tech.site_um),
            ports={net: sides[side](at) for side, net, at in placement["pins"]},
            femtofarad_um=femtofarad_um(tech, wire_corner(self.parameters.corner)),
            outside=dict.fromkeys(outputs, self.parameters.load_pf),
        )


def draw(layout: "db.Layout", library: "db.Layout", cells: dict[str, float], placed: list[list[Any]]) -> None:
    """Let the cells of the library among the instances be those ``placed``, with all masks. cells: their names."""
    top = layout.top_cell()
    for instance in list(top.each_inst()):
        if instance.cell.name in cells:
            instance.delete()
    indices = {}
    for cell in library.each_cell():
        drawn = layout.cell(cell.name) or layout.create_cell(cell.name)
        drawn.clear()
        drawn.copy_shapes(cell)
        indices[cell.name] = drawn.cell_index()
    for _, cell, x, y, orientation in placed:
        if cell in indices:
            turn = getattr(db.Trans, TURNS[orientation])
            top.insert(db.CellInstArray(indices[cell], db.Trans(turn, round(x / layout.dbu), round(y / layout.dbu))))
    for cell in layout.top_cells():
        if cell.cell_index() != top.cell_index():
            cell.prune_cell()
