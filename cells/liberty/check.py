"""What is missing in a Liberty library, and what physics does not allow."""

import re

import numpy as np

SLACK = 1e-3  # ns or a share by which a table may fall where it should rise: the solver's noise


def problems(library):
    """Texts, one a problem of Group ``library``: missing pins, arcs, tables; tables that fall with the load."""
    return [f"{cell.name}: {text}" for cell in library.all("cell") for text in _cell(cell)]


def _cell(cell):
    inputs = {p.name: p for p in cell.all("pin", direction="input")}
    outputs = cell.all("pin", direction="output")
    if not outputs:
        yield "has no output"
    for pin in inputs.values():
        if not pin.attributes.get("capacitance", 0) > 0:
            yield f"{pin.name} has no capacitance"
    if "cell_leakage_power" not in cell.attributes:
        yield "has no leakage"
    for pin in outputs:
        yield from _arcs(cell, pin, inputs)
        for timing in pin.all("timing"):
            for table in timing.groups:
                yield from _rises(pin.name, timing, table)
    yield from _constraints(cell, inputs)


def _arcs(cell, pin, inputs):
    """Every input that the function needs has a timing arc with both edges; what is stored has one from its clock."""
    function = pin.attributes.get("function", "")
    needed = set(re.findall(r"\w+", function)) & set(inputs)
    storage = cell.one("ff") or cell.one("latch")
    if storage and "IQ" in function:
        clock = storage.attributes.get("clocked_on") or storage.attributes.get("enable")
        needed = set(re.findall(r"\w+", clock))
    there = {t.attributes["related_pin"] for t in pin.all("timing")}
    for name in sorted(needed - there):
        yield f"{pin.name} has no arc from {name}"
    for name in sorted(set(re.findall(r"\w+", pin.attributes.get("three_state", ""))) & set(inputs)):
        for kind in ("three_state_enable", "three_state_disable"):
            if not pin.all("timing", related_pin=name, timing_type=kind):
                yield f"{pin.name} has no {kind} from {name}"
    for edge in ("rise", "fall") if inputs else ():
        if not any(t.one(f"cell_{edge}") for t in pin.all("timing")):
            yield f"{pin.name} never has cell_{edge}"


def _rises(name, timing, table):
    values = table.array("values")
    if np.ndim(values) != 2 or not np.isfinite(values).all():
        yield f"{name} from {timing.attributes['related_pin']}: {table.kind} is no table of numbers"
        return
    falls = np.diff(values, axis=1) < -SLACK * np.maximum(np.abs(values[:, 1:]), 1)
    if falls.any():
        yield f"{name} from {timing.attributes['related_pin']}: {table.kind} falls with the load"
    least = 0 if timing.attributes["timing_type"] == "three_state_disable" else 1e-9  # nothing moves then
    if table.kind.endswith("_transition") and (values < least).any():
        yield f"{name} from {timing.attributes['related_pin']}: {table.kind} is not above 0"


def _constraints(cell, inputs):
    """A flip-flop or latch has setup and hold for what it stores, recovery and removal for its set and reset."""
    storage = cell.one("ff") or cell.one("latch")
    if not storage:
        return
    data = storage.attributes.get("next_state") or storage.attributes.get("data_in")
    asyncs = " ".join(storage.attributes.get(name, "") for name in ("clear", "preset"))
    for text, needed in ((data, {"setup", "hold"}), (asyncs, {"recovery", "removal", "min"})):
        for name in sorted(set(re.findall(r"\w+", text)) & set(inputs)):
            kinds = {t.attributes["timing_type"].split("_")[0] for t in inputs[name].all("timing")}
            for kind in sorted(needed - kinds):
                yield f"{name} has no {'shortest pulse' if kind == 'min' else kind + ' time'}"
