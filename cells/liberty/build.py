"""Liberty from what the characterizer measured: ns, pF, pJ, nW, as SkyWater's libraries have it."""

from collections.abc import Iterable, Mapping, Sequence
from types import ModuleType
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from base.liberty.group import Group, Value
from cells.characterize.conditions import Conditions
from cells.characterize.measured import ArcTables, Constraint, Measured
from cells.netlist.function import Cell, PinLevel, Storage
from cells.netlist.states import Machine, Output

Floats = npt.NDArray[np.float64]
NS, PF, PJ, NW = 1e9, 1e12, 1e12, 1e9


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
    name: str,
    conditions: Conditions,
    cells: Sequence[Entry],
    process: ModuleType,
    constants: Mapping[str, Constant] | None = None,
) -> Group:
    """The library of ``cells`` and of those that hold a constant. process: a module like platforms.sky130.models."""
    corner = conditions.corner
    lib = Group(
        "library",
        (name,),
        {
            "technology": ("cmos",),
            "delay_model": "table_lookup",
            "time_unit": "1ns",
            "voltage_unit": "1V",
            "current_unit": "1mA",
            "leakage_power_unit": "1nW",
            "pulling_resistance_unit": "1kohm",
            "capacitive_load_unit": (1.0, "pf"),
            "nom_process": 1.0,
            "nom_temperature": corner.temperature,
            "nom_voltage": corner.supply,
        },
    )
    for edge in ("rise", "fall"):
        lib.attributes |= {
            f"input_threshold_pct_{edge}": 100 * conditions.middle,
            f"output_threshold_pct_{edge}": 100 * conditions.middle,
            f"slew_lower_threshold_pct_{edge}": 100 * conditions.lower,
            f"slew_upper_threshold_pct_{edge}": 100 * conditions.upper,
        }
    lib.attributes |= {
        "slew_derate_from_library": 1.0,
        "default_max_transition": NS * conditions.longest_slew,
        "default_cell_leakage_power": 0.0,
        "default_fanout_load": 0.0,
        "default_inout_pin_cap": 0.0,
        "default_input_pin_cap": 0.0,
        "default_output_pin_cap": 0.0,
        "default_leakage_power_density": 0.0,
    }
    ports = {port for entry in cells for port in entry.cell.machine.netlist.ports}
    lib.attributes["voltage_map"] = [
        (rail, level * corner.supply) for rail, level in process.SUPPLIES.items() if rail in ports
    ]
    lib.add(
        "operating_conditions",
        corner.name,
        process=1.0,
        temperature=corner.temperature,
        voltage=corner.supply,
        tree_type="balanced_tree",
    )
    _templates(lib, conditions, {_size(arc) for entry in cells for arc in entry.measured["arcs"]})
    lib.groups += [_cell(entry, process) for entry in cells]
    for cell, constant in (constants or {}).items():
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
        lib.add(
            "lu_table_template",
            f"delay_{size}",
            variable_1="input_net_transition",
            variable_2="total_output_net_capacitance",
            **axes,
        )
        lib.add(
            "power_lut_template",
            f"power_{size}",
            variable_1="input_transition_time",
            variable_2="total_output_net_capacitance",
            **axes,
        )
    lib.add("power_lut_template", "quiet", variable_1="input_transition_time", index_1=slews)
    lib.add(
        "lu_table_template",
        "constraint",
        variable_1="related_pin_transition",
        variable_2="constrained_pin_transition",
        index_1=constraint,
        index_2=constraint,
    )
    lib.add("lu_table_template", "width", variable_1="related_pin_transition", index_1=constraint)


def _cell(entry: Entry, process: ModuleType) -> Group:
    cell, measured = entry.cell, entry.measured
    machine = cell.machine
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
        _storage(group, cell.storage)
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
    for inputs, found in sorted(by_inputs.items()):
        for outputs, watts in found:
            names, levels = machine.inputs, inputs
            if len(found) > 1:
                names, levels = (*names, *machine.outputs[:1]), (*levels, *outputs[:1])
            group.add("leakage_power", value=NW * watts, when=_when(names, levels))
    group.attributes["cell_leakage_power"] = NW * float(np.mean([watts for _, _, watts in states]))


def _when(names: Iterable[str], levels: Iterable[Output]) -> str:
    return "&".join(("" if level else "!") + name for name, level in zip(names, levels, strict=True))


def _storage(group: Group, storage: Storage) -> None:
    if storage.kind == "gate":
        group.attributes["clock_gating_integrated_cell"] = _gating(storage)
    group.add("ff" if storage.kind == "ff" else "latch", "IQ", "IQ_N", **storage_attributes(storage))


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
        inside |= {
            "clear_preset_var1": "HL"[1 - storage.both] if storage.both in (0, 1) else "X",
            "clear_preset_var2": "L" if storage.both else "H",
        }
    return inside


def _gating(storage: Storage) -> str:
    edge = "posedge" if storage.active else "negedge"
    return f"latch_{edge}" + ("_precontrol" if len(storage.data_pins) > 1 else "")


def _input(group: Group, cell: Cell, measured: Measured, name: str) -> None:
    rise_fall = measured["capacitance"].get(name)
    pin = group.add("pin", name, direction="input")
    storage = cell.storage
    if storage and name == storage.clock and storage.kind != "latch":
        pin.attributes["clock"] = True
    if storage and storage.kind == "gate":
        pin.attributes[
            "clock_gate_clock_pin"
            if name == storage.clock
            else "clock_gate_enable_pin"
            if name == storage.data_pins[0]
            else "clock_gate_test_pin"
        ] = True
    _capacitance(pin, rise_fall)
    _rails(pin, cell)
    energy = measured["quiet_energy"].get(name)
    if energy:
        power = pin.add("internal_power", related_pg_pin=pin.text("related_power_pin"))
        for edge in ("rise", "fall"):
            power.add(
                f"{edge}_power", "quiet", index_1=NS * np.array(measured["slews"]), values=PJ * np.array(energy[edge])
            )
    for constraint in measured["constraints"]:
        if constraint["pin"] == name:
            _constraint(pin, constraint)


def _capacitance(pin: Group, rise_fall: tuple[float, float] | None) -> None:
    if rise_fall:
        pin.attributes |= {
            "capacitance": PF * sum(rise_fall) / 2,
            "rise_capacitance": PF * rise_fall[0],
            "fall_capacitance": PF * rise_fall[1],
        }


def _rails(pin: Group, cell: Cell) -> None:
    ports = cell.machine.netlist.ports
    for name, candidates in (("related_power_pin", ("VPWR", "vdd")), ("related_ground_pin", ("VGND", "vss"))):
        for rail in candidates:
            if rail in ports:
                pin.attributes[name] = rail


def _constraint(pin: Group, found: Constraint) -> None:
    timing = pin.add("timing", related_pin=found["related"], timing_type=found["type"])
    for edge in ("rise", "fall"):
        values = found.get(edge)
        if values is None:
            continue
        axes: dict[str, Value] = {"index_1": NS * np.array(found["slews"])}
        if np.ndim(values) == 2:
            axes["index_2"] = NS * np.array(found["slews"])
        timing.add(
            f"{edge}_constraint",
            "constraint" if np.ndim(values) == 2 else "width",
            **axes,
            values=NS * np.array(values),
        )


def _output(group: Group, cell: Cell, measured: Measured, name: str) -> None:
    pin = group.add("pin", name, direction="output", function=cell.functions[name])
    if three_state := cell.three_state[name]:
        pin.attributes["three_state"] = three_state
        _capacitance(pin, measured["capacitance"].get(name))
    if cell.storage and cell.storage.kind == "gate":
        pin.attributes["clock_gate_out_pin"] = True
    if name in measured["largest_load"]:
        pin.attributes["max_capacitance"] = PF * measured["largest_load"][name]
    pin.attributes["max_transition"] = NS * measured["slews"][-1]
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
        same = [arc for arc in arcs if arc["edge"] == edge]
        if same:
            energy = np.mean([arc["energy"] for arc in same if "energy" in arc], axis=0)
            _table(power, f"{edge}_power", "power", same[0], PJ * energy)


def _table(group: Group, kind: str, template: str, arc: ArcTables, values: Floats) -> None:
    group.add(
        kind,
        f"{template}_{_size(arc)}",
        index_1=NS * np.array(arc["slews"]),
        index_2=PF * np.array(arc["loads"]),
        values=values,
    )
