"""Liberty from what the characterizer measured: ns, pF, pJ, nW, as SkyWater's libraries have it."""

from collections.abc import Iterable, Mapping, Sequence
from types import ModuleType
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from talbot.base.liberty.group import Group, Value
from talbot.cells.characterize.conditions import Conditions
from talbot.cells.characterize.measured import ArcTables, Constraint, Measured
from talbot.cells.netlist.function import Cell, PinLevel, Storage
from talbot.cells.netlist.states import Machine, Output

Floats = npt.NDArray[np.float64]
NS, PF, PJ, NW = 1e9, 1e12, 1e12, 1e9
UNITS: dict[str, Value] = {"time": "1ns", "voltage": "1V", "current": "1mA", "leakage_power": "1nW"}
UNITS |= {"pulling_resistance": "1kohm", "capacitive_load": (1.0, "pf")}
ZERO = ["cell_leakage_power", "fanout_load", "inout_pin_cap", "input_pin_cap", "output_pin_cap"]  # by default
ZERO += ["leakage_power_density"]
SLEW_IN, LOAD = "input_transition_time", "total_output_net_capacitance"  # Liberty's names of axes


class Entry(NamedTuple):
    """A cell with what was measured of it; area: um2, None without a layout."""

    cell: Cell
    measured: Measured
    area: float | None


class Constant(NamedTuple):
    """A cell that holds constants: level of each pin, area in um2."""

    levels: dict[str, int]
    area: float


def library(
    name: str, c: Conditions, cells: Sequence[Entry], process: ModuleType, constants: Mapping[str, Constant]
) -> Group:
    """The library of ``cells`` and of those that hold a constant. process: a module like platforms.sky130.models."""
    lib = Group("library", (name,), {"technology": ("cmos",), "delay_model": "table_lookup"})
    lib.attributes |= {f"{quantity}_unit": unit for quantity, unit in UNITS.items()}
    nominal = {"process": 1.0, "temperature": c.corner.temperature, "voltage": c.corner.supply}
    lib.attributes |= {f"nom_{quantity}": value for quantity, value in nominal.items()}
    thresholds = {"input": c.middle, "output": c.middle, "slew_lower": c.lower, "slew_upper": c.upper}
    for edge in ("rise", "fall"):
        lib.attributes |= {f"{kind}_threshold_pct_{edge}": 100 * share for kind, share in thresholds.items()}
    lib.attributes |= {"slew_derate_from_library": 1.0, "default_max_transition": NS * c.longest_slew}
    lib.attributes |= dict.fromkeys((f"default_{name}" for name in ZERO), 0.0)
    ports = {port for entry in cells for port in entry.cell.machine.netlist.ports}
    levels = {rail: level for rail, level in process.SUPPLIES.items() if rail in ports}
    lib.attributes["voltage_map"] = [(rail, level * c.corner.supply) for rail, level in levels.items()]
    lib.add("operating_conditions", c.corner.name, **nominal, tree_type="balanced_tree")
    _templates(lib, c, {_size(arc) for entry in cells for arc in entry.measured["arcs"]})
    lib.groups += [_cell(entry, process) for entry in cells]
    for cell, constant in constants.items():
        group = lib.add("cell", cell, area=constant.area, cell_leakage_power=0.0)
        for pin, level in constant.levels.items():
            group.add("pin", pin, direction="output", function=str(level))
    return lib


def _size(arc: ArcTables) -> str:
    """The size of an arc's tables ('9_7': slews, loads). ABC expects a template of this size for every table."""
    return f"{len(arc['slews'])}_{len(arc['loads'])}"


def _templates(lib: Group, c: Conditions, sizes: Iterable[str]) -> None:
    slews, constraint = NS * np.array(c.slews), NS * np.array(c.constraint_slews)
    for size in sorted(sizes):
        rows, columns = map(int, size.split("_"))
        axes: dict[str, Value] = {
            "index_1": NS * np.geomspace(c.slews[0], c.slews[-1], rows),
            "index_2": PF * np.geomspace(c.least_load, 100 * c.least_load, columns),
        }
        lib.add("lu_table_template", f"delay_{size}", variable_1="input_net_transition", variable_2=LOAD, **axes)
        lib.add("power_lut_template", f"power_{size}", variable_1=SLEW_IN, variable_2=LOAD, **axes)
    lib.add("power_lut_template", "quiet", variable_1=SLEW_IN, index_1=slews)
    pins = {"variable_1": "related_pin_transition", "variable_2": "constrained_pin_transition"}
    lib.add("lu_table_template", "constraint", **pins, index_1=constraint, index_2=constraint)
    lib.add("lu_table_template", "width", variable_1="related_pin_transition", index_1=constraint)


def _cell(entry: Entry, process: ModuleType) -> Group:
    cell, measured, machine = entry.cell, entry.measured, entry.cell.machine
    group = Group("cell", (cell.name,))
    if entry.area is not None:
        group.attributes["area"] = float(entry.area)
    _leakage(group, machine, measured["leakage"])
    for rail, level in process.SUPPLIES.items():
        if rail in machine.netlist.ports:
            well = rail in process.WELLS
            kind = ("nwell" if level else "pwell") if well else "primary_power" if level else "primary_ground"
            group.add("pg_pin", rail, pg_type=kind, voltage_name=rail)
    if cell.storage:
        if cell.storage.kind == "gate":
            group.attributes["clock_gating_integrated_cell"] = gating(cell.storage)
        group.add("ff" if cell.storage.kind == "ff" else "latch", "IQ", "IQ_N", **storage_attributes(cell.storage))
    for pin in machine.inputs:
        _input(group, cell, measured, pin)
    for output in machine.outputs:
        _output(group, cell, measured, output)
    return group


def _leakage(group: Group, machine: Machine, states: Sequence[tuple[list[int], list[Output], float]]) -> None:
    if not states:
        return
    by_inputs = {}
    for inputs, outputs, watts in states:
        by_inputs.setdefault(tuple(inputs), []).append((outputs, watts))
    for inputs, values in sorted(by_inputs.items()):
        for outputs, watts in values:
            names, levels = machine.inputs, inputs
            if len(values) > 1:
                names, levels = (*names, *machine.outputs[:1]), (*levels, *outputs[:1])
            group.add("leakage_power", value=NW * watts, when=_when(names, levels))
    group.attributes["cell_leakage_power"] = NW * float(np.mean([watts for _, _, watts in states]))


def _when(names: Iterable[str], levels: Iterable[Output]) -> str:
    return "&".join(("" if level else "!") + name for name, level in zip(names, levels, strict=True))


def storage_attributes(storage: Storage) -> dict[str, str]:
    """The attributes of a cell's group ff, or latch."""
    if storage.kind == "ff":
        inside = {"clocked_on": storage.clocked_on, "next_state": storage.data}
    elif storage.kind == "latch":
        inside = {"enable": storage.clocked_on, "data_in": storage.data}
    else:
        inside = {"enable": PinLevel(storage.clock, 1 - storage.active).active, "data_in": storage.data}
    inside |= {name: pin.active for name, pin in (("clear", storage.clear), ("preset", storage.preset)) if pin}
    if storage.both is not None:
        inside["clear_preset_var1"] = "HL"[1 - storage.both] if storage.both in (0, 1) else "X"
        inside["clear_preset_var2"] = "L" if storage.both else "H"
    return inside


def gating(storage: Storage) -> str:
    """Liberty's name for what a clock gate does."""
    edge = "posedge" if storage.active else "negedge"
    return f"latch_{edge}" + ("_precontrol" if len(storage.data_pins) > 1 else "")


def _input(group: Group, cell: Cell, measured: Measured, name: str) -> None:
    pin, storage = group.add("pin", name, direction="input"), cell.storage
    if storage and name == storage.clock and storage.kind != "latch":
        pin.attributes["clock"] = True
    if storage and storage.kind == "gate":
        role = {storage.clock: "clock", storage.data_pins[0]: "enable"}.get(name, "test")
        pin.attributes[f"clock_gate_{role}_pin"] = True
    pin.attributes["max_transition"] = NS * measured["longest_slew"]  # OpenSTA takes the default for outputs alone
    _capacitance(pin, measured["capacitance"].get(name))
    _rails(pin, cell)
    if energy := measured["quiet_energy"].get(name):
        power, slews = pin.add("internal_power", related_pg_pin=pin.text("related_power_pin")), measured["slews"]
        for edge in ("rise", "fall"):
            power.add(f"{edge}_power", "quiet", index_1=NS * np.array(slews), values=PJ * np.array(energy[edge]))
    for constraint in measured["constraints"]:
        if constraint["pin"] == name:
            _constraint(pin, constraint)


def _capacitance(pin: Group, rise_fall: tuple[float, float] | None) -> None:
    if rise_fall:
        pin.attributes["capacitance"] = PF * sum(rise_fall) / 2
        pin.attributes["rise_capacitance"], pin.attributes["fall_capacitance"] = (PF * farad for farad in rise_fall)


def _rails(pin: Group, cell: Cell) -> None:
    ports = cell.machine.netlist.ports
    for name, candidates in (("related_power_pin", ("VPWR", "vdd")), ("related_ground_pin", ("VGND", "vss"))):
        for rail in candidates:
            if rail in ports:
                pin.attributes[name] = rail


def _constraint(pin: Group, constraint: Constraint) -> None:
    timing = pin.add("timing", related_pin=constraint["related"], timing_type=constraint["type"])
    for edge in ("rise", "fall"):
        if (values := constraint.get(edge)) is not None:
            template = "constraint" if np.ndim(values) == 2 else "width"
            axes = {f"index_{k + 1}": NS * np.array(constraint["slews"]) for k in range(np.ndim(values))}
            timing.add(f"{edge}_constraint", template, **axes, values=NS * np.array(values))


def _output(group: Group, cell: Cell, measured: Measured, name: str) -> None:
    pin = group.add("pin", name, direction="output", function=cell.functions[name])
    if three_state := cell.three_state[name]:
        pin.attributes["three_state"] = three_state
        _capacitance(pin, measured["capacitance"].get(name))
    if cell.storage and cell.storage.kind == "gate":
        pin.attributes["clock_gate_out_pin"] = True
    if name in measured["largest_load"]:
        pin.attributes["max_capacitance"] = PF * measured["largest_load"][name]
    pin.attributes["max_transition"] = NS * measured["longest_slew"]
    _rails(pin, cell)
    arcs = {}
    for arc in measured["arcs"]:
        if arc["output"] == name:
            arcs.setdefault((arc["pin"], arc["type"], arc["sense"]), {})[arc["edge"]] = arc
    for (related, kind, sense), edges in sorted(arcs.items()):
        timing = pin.add("timing", related_pin=related, timing_sense=sense, timing_type=kind)
        for edge, arc in sorted(edges.items()):
            _table(timing, f"cell_{edge}", "delay", arc, NS * np.array(arc["delay"]))
            _table(timing, f"{edge}_transition", "delay", arc, NS * np.array(arc["slew"]))
    powered = [arc for arc in measured["arcs"] if arc["output"] == name and "energy" in arc]
    for related in sorted({arc["pin"] for arc in powered}):
        _power(pin, related, [arc for arc in powered if arc["pin"] == related])


def _power(pin: Group, related: str, arcs: Sequence[ArcTables]) -> None:
    """Add the energy by output edge: the mean of the arcs that cause it."""
    power = pin.add("internal_power", related_pin=related, related_pg_pin=pin.text("related_power_pin"))
    for edge in ("fall", "rise"):
        if same := [arc for arc in arcs if arc["edge"] == edge]:
            energy = np.mean([arc["energy"] for arc in same if "energy" in arc], axis=0)
            _table(power, f"{edge}_power", "power", same[0], PJ * energy)


def _table(group: Group, kind: str, template: str, arc: ArcTables, values: Floats) -> None:
    slews, loads = NS * np.array(arc["slews"]), PF * np.array(arc["loads"])
    group.add(kind, f"{template}_{_size(arc)}", index_1=slews, index_2=loads, values=values)
