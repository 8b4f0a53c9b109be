"""Cells sized and buffered for their wires, in the empty places of a placement."""

import json
from copy import deepcopy
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from talbot.base.gds import db, read_gds, write_gds
from talbot.base.liberty.read import read
from talbot.base.steps import Files, Step
from talbot.models.parameters import check_real
from talbot.platforms.coriolis import coriolis_platform
from talbot.platforms.wires import wire_corner

from ..geometry.instances import insert
from ..netlist.netlist import Netlist
from ..repair.clock import regrouped
from ..repair.drive import Drives
from ..repair.repair import OWN, Plan, borne, clock_nets, eased, planned, repaired, shortened
from ..repair.speed import Delays, quickened
from ..repair.wires import femtofarad_um
from ..timing.estimate import setup_slacks
from .synthesis import CLOCK_CELLS, CLOCK_GATE, REGISTERS

MARGIN_NS = 0.8  # of the estimated setup slack
ROUTED_NS = 1.2  # slew of a net as long as it may be when it is routed: the rest is what neighbours add
CLOCK_NS, BUFFERED_NS = 0.7, 0.3  # most slew of a register's clock; behind a buffer of a late path
# Nets with at most so much slack more than the worst are changed in a round; less after one that did not help
ROUNDS, WINDOW_NS, SHRINK, LEAST_NS = 40, 0.3, 0.6, 0.01


@dataclass(frozen=True)
class RepairParameters:
    """Parameters of `Repair`.

    pdk: process. corner: of the cells' timing that decides. slew_ns: the most of any net. load_pf: of an output.
    """

    pdk: str = "sky130"
    corner: str = ""
    slew_ns: float = field(default=1.05, metadata={"unit": "ns"})
    load_pf: float = field(default=0.0, metadata={"unit": "pF"})

    def __post_init__(self) -> None:
        check_real("slew_ns", self.slew_ns, 0.05, 10)
        check_real("load_pf", self.load_pf, 0, 1000)


class Repair(Step[RepairParameters]):
    """Drivers that are too weak at the slowest corner for the wires that a placement implies get larger or a buffer.

    lengths: um of nets that their drivers bear when they are routed, {net: um}.
    estimate_ns: the setup slack that is expected before drivers are eased. Without timing nothing changes but that all
    masks of the cells are drawn, which Coriolis does not know.
    """

    name = "repair"
    inputs = {
        "gds": "place.gds",
        "netlist": "arrange.netlist",
        "placement": "arrange.placement",
        "floorplan": "floorplan.floorplan",
        "masks": "library.gds",
        "areas": "library.areas",
    }
    outputs = {
        "gds": "repaired.gds",
        "netlist": "netlist.json",
        "verilog": "final.v",
        "placement": "placement.json",
        "lengths": "lengths.json",
    }
    metrics = {
        "clock_drivers": "",
        "halfway": "",
        "sized": "",
        "buffers": "",
        "cells": "",
        "cell_area_um2": "um2",
        "estimate_ns": "ns",
    }
    tools = ("python klayout",)

    def __init__(self, parameters: RepairParameters) -> None:
        super().__init__(parameters)
        if parameters.corner:
            self.inputs = {**self.inputs, "liberty": f"timing.{parameters.corner}", "sdc": "sdc"}
            self.tools = (*self.tools, "sta")

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        p, tech = self.parameters, coriolis_platform(self.parameters.pdk)
        netlist, placement = (
            Netlist.read(inputs["netlist"]),
            json.loads(inputs["placement"].read_text(encoding="utf-8")),
        )
        areas = json.loads(inputs["areas"].read_text(encoding="utf-8"))
        layout, counts, lengths = (
            read_gds(inputs["gds"]),
            {"clock_drivers": 0, "halfway": 0, "sized": 0, "buffers": 0, "estimate_ns": None},
            dict[str, float](),
        )
        if p.corner:
            begin = planned(
                netlist, placement, json.loads(inputs["floorplan"].read_text(encoding="utf-8")), areas, tech
            )
            begin.femtofarad_um = femtofarad_um(tech, wire_corner(p.corner))
            outputs_of = (net for port in netlist.ports if port.direction == "output" for net in port.bits())
            begin.outside = dict.fromkeys(outputs_of, p.load_pf)
            plan, lengths, counts = self.best(begin, netlist, inputs)
            netlist, placement["instances"] = plan.listed(netlist, placement["instances"], tech.fill_cells)
        draw(layout, read_gds(inputs["masks"]), areas, placement["instances"])
        write_gds(layout, outputs["gds"])
        netlist.write(outputs["netlist"])
        outputs["verilog"].write_text(netlist.verilog(), encoding="utf-8")
        outputs["lengths"].write_text(json.dumps(lengths, indent=0) + "\n", encoding="utf-8")
        outputs["placement"].write_text(json.dumps(placement, indent=0) + "\n", encoding="utf-8")
        cells = [instance.cell for instance in netlist.instances if instance.pins]
        return counts | {"cells": len(cells), "cell_area_um2": round(sum(areas.get(cell, 0) for cell in cells), 2)}

    def best(self, plan: Plan, netlist: Netlist, inputs: Files) -> tuple[Plan, dict[str, float], dict[str, float]]:
        """The plan of most setup slack that ``plan`` leads to, its drivers eased; the step's lengths and metrics."""
        liberty = read(inputs["liberty"])
        delays, limits, short = (
            Delays.of(liberty), Drives.of(liberty, self.parameters.slew_ns), Drives.of(liberty, BUFFERED_NS)
        )  # fmt: skip
        added, slacks, window = 0, dict[tuple[str, str], float](), WINDOW_NS
        best = -np.inf, plan, slacks
        if CLOCK_GATE.cell in plan.widths:
            added = regrouped(plan, Drives.of(liberty, CLOCK_NS), CLOCK_CELLS, REGISTERS)
        kept = clock_nets(plan.instances.values())
        halfway = shortened(plan, limits, kept)
        for _ in range(ROUNDS):
            repaired(plan, limits, kept, slacks)
            now = replace(netlist, instances=tuple(plan.instances.values()))
            slacks = setup_slacks(now, plan.wires(), inputs["liberty"], inputs["sdc"])
            if min(slacks.values()) > best[0]:
                best = min(slacks.values()), deepcopy(plan), slacks
            else:  # go on from the best, with less at a time
                window *= SHRINK
                plan, slacks = deepcopy(best[1]), best[2]
            if best[0] >= MARGIN_NS or window < LEAST_NS:
                break
            quickened(plan, short, delays, kept, slacks, best[0] + window)
        worst, plan, _ = best
        routed = Drives.of(liberty, ROUTED_NS)
        eased(plan, routed, kept)
        cells = {instance.name: instance.cell for instance in netlist.instances}
        sized = sum(instance.cell != cells.get(name, instance.cell) for name, instance in plan.instances.items())
        counts = {"sized": sized, "halfway": halfway, "buffers": sum(name.endswith(OWN) for name in plan.instances)}
        return plan, borne(plan, routed), {"clock_drivers": added, "estimate_ns": round(worst, 3), **counts}


def draw(layout: "db.Layout", library: "db.Layout", cells: dict[str, float], placed: list[list[Any]]) -> None:
    """Let the cells of the library among the instances be those ``placed``, with all masks. cells: their names."""
    top = layout.top_cell()
    for instance in list(top.each_inst()):
        if instance.cell.name in cells:
            instance.delete()
    for cell in library.each_cell():
        drawn = layout.cell(cell.name) or layout.create_cell(cell.name)
        drawn.clear()
        drawn.copy_shapes(cell)
    for _, cell, *place in placed:
        if cell in cells:
            insert(top, library, cell, *place)
    for cell in layout.top_cells():
        if cell.cell_index() != top.cell_index():
            cell.prune_cell()
