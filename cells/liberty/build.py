"""Liberty from what the characterizer measured: ns, pF, pJ, nW, as SkyWater's libraries have it."""

import numpy as np

from base.liberty.group import Group

NS, PF, PJ, NW = 1e9, 1e12, 1e12, 1e9
TABLES = {"delay": "cell_{}", "slew": "{}_transition"}


def library(name, conditions, cells, process, constants=None):
    """Group 'library'. cells: [(Cell, measured dict, area in um2 or None)]; process: module with SUPPLIES.

    constants: cell -> ({pin: level}, um2), cells that hold a constant.
    """
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
    for rail, level in process.SUPPLIES.items():
        if any(rail in cell.machine.netlist.ports for cell, _, _ in cells):
            lib.attributes.setdefault("voltage_map", []).append((rail, level * corner.supply))
    lib.add(
        "operating_conditions",
        corner.name,
        process=1.0,
        temperature=corner.temperature,
        voltage=corner.supply,
        tree_type="balanced_tree",
    )
    _templates(lib, conditions, {_size(arc) for _, measured, _ in cells for arc in measured["arcs"]})
    for cell, measured, area in cells:
        lib.groups.append(_cell(cell, measured, area, process))
    for cell, (pins, area) in (constants or {}).items():
        group = lib.add("cell", cell, area=area, cell_leakage_power=0.0)
        for pin, level in pins.items():
            group.add("pin", pin, direction="output", function=str(level))
    return lib


def _size(arc):
    """'9_7': slews and loads of an arc's tables. ABC wants a template of just that size for every table."""
    return f"{len(arc['slews'])}_{len(arc['loads'])}"


def _templates(lib, c, sizes):
    slews, constraint = NS * np.array(c.slews), NS * np.array(c.constraint_slews)
    for size in sorted(sizes):
        rows, columns = map(int, size.split("_"))
        axes = {
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


def _cell(cell, measured, area, process):
    machine = cell.machine
    group = Group("cell", (cell.name,))
    if area is not None:
        group.attributes["area"] = float(area)
    _leakage(group, machine, measured["leakage"])
    for rail, level in process.SUPPLIES.items():
        if rail in machine.netlist.ports:
            well = rail in process.WELLS
            kind = ("nwell" if level else "pwell") if well else "primary_power" if level else "primary_ground"
            group.add("pg_pin", rail, pg_type=kind, voltage_name=rail)
    _storage(group, cell)
    for pin in machine.inputs:
        _input(group, cell, measured, pin)
    for output in machine.outputs:
        _output(group, cell, measured, output)
    return group


def _leakage(group, machine, states):
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


def _when(names, levels):
    return "&".join(("" if level else "!") + name for name, level in zip(names, levels, strict=True))


def _storage(group, cell):
    s = cell.storage
    if s is None:
        return
    clock = s.clock if s.active else f"!{s.clock}"
    if s.kind == "ff":
        inside = {"clocked_on": clock, "next_state": s.data}
    elif s.kind == "latch":
        inside = {"enable": clock, "data_in": s.data}
    else:
        group.attributes["clock_gating_integrated_cell"] = _gating(s)
        inside = {"enable": f"!{s.clock}" if s.active else s.clock, "data_in": s.data}
    for name, hit in (("clear", s.clear), ("preset", s.preset)):
        if hit:
            inside[name] = hit[0] if hit[1] else f"!{hit[0]}"
    if s.both is not None:
        inside |= {
            "clear_preset_var1": "HL"[1 - s.both] if s.both in (0, 1) else "X",
            "clear_preset_var2": "L" if s.both else "H",
        }
    group.add("ff" if s.kind == "ff" else "latch", "IQ", "IQ_N", **inside)


def _gating(storage):
    edge = "posedge" if storage.active else "negedge"
    return f"latch_{edge}" + ("_precontrol" if len(storage.data_pins) > 1 else "")


def _input(group, cell, measured, name):
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
        power = pin.add("internal_power", related_pg_pin=pin.attributes["related_power_pin"])
        for edge in ("rise", "fall"):
            power.add(
                f"{edge}_power", "quiet", index_1=NS * np.array(measured["slews"]), values=PJ * np.array(energy[edge])
            )
    for constraint in measured["constraints"]:
        if constraint["pin"] == name:
            _constraint(pin, constraint)


def _capacitance(pin, rise_fall):
    if rise_fall:
        pin.attributes |= {
            "capacitance": PF * sum(rise_fall) / 2,
            "rise_capacitance": PF * rise_fall[0],
            "fall_capacitance": PF * rise_fall[1],
        }


def _rails(pin, cell):
    ports = cell.machine.netlist.ports
    for name, candidates in (("related_power_pin", ("VPWR", "vdd")), ("related_ground_pin", ("VGND", "vss"))):
        pin.attributes |= {name: rail for rail in candidates if rail in ports}


def _constraint(pin, found):
    timing = pin.add("timing", related_pin=found["related"], timing_type=found["type"])
    for edge in ("rise", "fall"):
        values = found.get(edge)
        if values is None:
            continue
        axes = {"index_1": NS * np.array(found["slews"])}
        if np.ndim(values) == 2:
            axes["index_2"] = NS * np.array(found["slews"])
        timing.add(
            f"{edge}_constraint",
            "constraint" if np.ndim(values) == 2 else "width",
            **axes,
            values=NS * np.array(values),
        )


def _output(group, cell, measured, name):
    pin = group.add("pin", name, direction="output", function=cell.functions[name])
    if cell.three_state[name]:
        pin.attributes["three_state"] = cell.three_state[name]
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
            for field, table in TABLES.items():
                _table(timing, table.format(edge), "delay", arc, NS * np.array(arc[field]))
    powered = [arc for arc in measured["arcs"] if arc["output"] == name and "energy" in arc]
    for related in sorted({arc["pin"] for arc in powered}):
        _power(pin, related, [arc for arc in powered if arc["pin"] == related])


def _power(pin, related, arcs):
    """Energy by output edge: of the arcs that cause it, the mean."""
    power = pin.add("internal_power", related_pin=related, related_pg_pin=pin.attributes["related_power_pin"])
    for edge in ("fall", "rise"):
        same = [a for a in arcs if a["edge"] == edge]
        if same:
            _table(power, f"{edge}_power", "power", same[0], PJ * np.mean([a["energy"] for a in same], axis=0))


def _table(group, kind, template, arc, values):
    group.add(
        kind,
        f"{template}_{_size(arc)}",
        index_1=NS * np.array(arc["slews"]),
        index_2=PF * np.array(arc["loads"]),
        values=values,
    )
