"""The block's Liberty at one corner: delays, constraints and capacitances at its ports."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from talbot.base.liberty.group import Group
from talbot.base.liberty.read import read
from talbot.base.liberty.write import text
from talbot.base.steps import Files, StepError
from talbot.base.tools import run
from talbot.flow.layout.power.energy import Cells
from talbot.flow.layout.steps.corner import CornerStep
from talbot.flow.layout.timing.boundary import CHECK_LOAD_PF, CHECK_SLEW_NS, Boundary, Sources, measure
from talbot.signoff.netlist.netlist import SUPPLIES, Netlist, supplies

SLEWS = 0.02, 0.07, 0.25, 1.0  # ns
LOADS = 0.001, 0.006, 0.02, 0.035, 0.06, 0.2  # pF
EDGES = "rise", "fall"
COMBINATIONAL = {"timing_type": "combinational", "timing_sense": "non_unate"}
DELAY = {"index_1": np.array(SLEWS), "index_2": np.array(LOADS)}  # axes of the tables
CONSTRAINT = {"index_1": np.array(SLEWS), "index_2": np.array(SLEWS)}
TEMPLATES = (
    ("delay", "input_net_transition", "total_output_net_capacitance", DELAY),
    ("constraint", "related_pin_transition", "constrained_pin_transition", CONSTRAINT),
)


@dataclass(frozen=True)
class BlockLibertyParameters:
    """Corner, and port of the clock."""

    corner: str = ""
    clock: str = "clk"


class BlockLiberty(CornerStep[BlockLibertyParameters]):
    """Timing of the ports from OpenSTA's slacks; no power but leakage.

    Outputs have their latest delay from the clock, and from inputs that reach them through cells alone; inputs have
    their setup and hold at the clock's port. The file is read back into OpenSTA and compared at a slew and a load off
    the grid: model_error_ns.
    """

    name = "block_liberty_{corner}"
    inputs = {"netlist": "stream_out.netlist", "verilog": "stream_out.verilog", "spef": "extraction.{wires}"}
    inputs |= {"liberty": "timing.{corner}", "areas": "stream_out.plan"}
    outputs = {"liberty": "block.lib"}
    metrics = {"model_error_ns": "ns", "arcs": ""}
    tools = ("openroad", "yosys")

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        clock, folder = self.parameters.clock, outputs["liberty"].parent
        netlist, plan = Netlist.read(inputs["netlist"]), json.loads(inputs["areas"].read_text(encoding="utf-8"))
        files = Sources(inputs["liberty"], inputs["verilog"], folder, inputs["spef"])
        found = measure(netlist, clock, files, SLEWS, LOADS)
        corner, area = self.parameters.corner, plan["width_um"] * plan["height_um"]
        model = liberty(netlist, clock, found, corner, inputs["liberty"], area, supplies(plan))
        outputs["liberty"].write_text(model, encoding="utf-8")
        error = self.model_error(netlist, files, outputs["liberty"])
        return {"model_error_ns": error, "arcs": len(found.delays) + len(found.checks)}

    def model_error(self, netlist: Netlist, files: Sources, made: Path) -> float:
        """Largest difference (ns) between the model in a wrapper and the netlist, off the grid. Raises StepError."""
        run(["yosys", "-q", "-p", f"read_liberty -lib {made}; hierarchy -check -top {netlist.name}"])
        wrapper = files.folder / "wrapper.log"
        wrapper.write_text(_wrapper(netlist), encoding="utf-8")
        point = (CHECK_SLEW_NS,), (CHECK_LOAD_PF,)
        own = measure(netlist, self.parameters.clock, files, *point)
        model = measure(netlist, self.parameters.clock, Sources(made, wrapper, files.folder, top="Wrapper"), *point)
        differences = []
        for name in ("delays", "checks"):
            one, other = getattr(own, name), getattr(model, name)
            if set(one) != set(other):
                raise StepError(f"{self.name}: OpenSTA does not find the arcs {sorted(set(one) ^ set(other))[:3]}")
            differences += [abs(one[arc][at] - other[arc][at]) for arc in one for at in one[arc]]
        return round(max(differences, default=0.0), 4)


def _wrapper(netlist: Netlist) -> str:
    names = [port.name for port in netlist.ports]
    lines = [f"module Wrapper ({', '.join(names)});"]
    for port in netlist.ports:
        lines.append(f"  {port.direction} {f'[{port.width - 1}:0] ' if port.width > 1 else ''}{port.name};")
    lines.append(f"  {netlist.name} block ({', '.join(f'.{name}({name})' for name in names)});")
    return "\n".join([*lines, "endmodule", ""])


def liberty(
    netlist: Netlist, clock: str, found: Boundary, corner: str, source: Path, area: float,
    supplies: Sequence[str] = SUPPLIES,
) -> str:  # fmt: skip
    """Text of the Liberty. source: the cells' Liberty, whose units and thresholds it has. area: um2."""
    cells = read(source)
    attributes = {name: value for name, value in cells.attributes.items() if not name.startswith("default_")}
    attributes["voltage_map"] = [(supplies[0], cells.number("nom_voltage")), (supplies[1], 0.0)]
    library = Group("library", (f"{netlist.name}__{corner}",), attributes)
    if conditions := cells.one("operating_conditions"):
        library.groups.append(conditions)
    leakage = round(sum(map(Cells(cells).leakage_nw, (i.cell for i in netlist.instances))), 4)
    for name, one, other, axes in TEMPLATES:
        library.add("lu_table_template", name, variable_1=one, variable_2=other, **axes)
    for width in sorted({port.width for port in netlist.ports if port.width > 1}):
        bits: dict[str, int] = {"bit_width": width, "bit_from": width - 1, "bit_to": 0, "downto": True}
        library.add("type", f"bus{width}", base_type="array", data_type="bit", **bits)
    cell = library.add("cell", netlist.name, area=round(area, 4), cell_leakage_power=leakage)
    for flag in ("dont_touch", "dont_use", "interface_timing"):  # without the last OpenSTA finds latches
        cell.attributes[flag] = True
    for supply, kind in zip(supplies, ("primary_power", "primary_ground"), strict=True):
        cell.add("pg_pin", supply, pg_type=kind, voltage_name=supply)
    for port in netlist.ports:
        group = cell
        if port.width > 1:
            group = cell.add("bus", port.name, bus_type=f"bus{port.width}", direction=port.direction)
        for net in port.bits():
            pin = group.add("pin", net, direction=port.direction)
            if port.direction == "input":
                pin.attributes |= {"capacitance": found.capacitance[net], **({"clock": True} if net == clock else {})}
                _constraints(pin, net, clock, found)
            else:
                pin.attributes["max_capacitance"] = LOADS[-1]
                _delays(pin, net, clock, found)
    return text(library)


def _constraints(pin: Group, net: str, clock: str, found: Boundary) -> None:
    for kind, timing_type in (("max", "setup_rising"), ("min", "hold_rising")):
        if (net, kind, "rise") in found.checks:
            timing = pin.add("timing", related_pin=clock, timing_type=timing_type)
            for edge in EDGES:
                table = found.checks[net, kind, edge]
                values = np.array([[table[a, b] for b in SLEWS] for a in SLEWS])
                timing.add(f"{edge}_constraint", "constraint", **CONSTRAINT, values=values)


def _delays(pin: Group, net: str, clock: str, found: Boundary) -> None:
    for source in sorted({source for source, output, _ in found.delays if output == net}):
        more = {"timing_type": "rising_edge"} if source == clock else COMBINATIONAL
        timing = pin.add("timing", related_pin=source, **more)
        for edge in EDGES:
            tables = {f"cell_{edge}": found.delays[source, net, edge], f"{edge}_transition": found.slews[net, edge]}
            for name, table in tables.items():
                timing.add(name, "delay", **DELAY, values=np.array([[table[a, b] for b in LOADS] for a in SLEWS]))
