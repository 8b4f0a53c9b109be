"""Checks of a Liberty library: what is missing, and what physics does not allow."""

import re
from collections.abc import Iterator

import numpy as np

from talbot.base.liberty.group import Group

SLACK = 1e-3  # ns, or relative, by which a table may fall where it should rise: the solver's noise


def problems(library: Group) -> list[str]:
    """The problems of a library, one a text: missing pins, arcs, tables; tables that fall with the load."""
    return [f"{cell.name}: {text}" for cell in library.all("cell") for text in _cell(cell)]


def _cell(cell: Group) -> Iterator[str]:
    inputs = {p.name: p for p in cell.all("pin", direction="input")}
    outputs = cell.all("pin", direction="output")
    if not outputs:
        yield "has no output"
    for pin in inputs.values():
        if not pin.number("capacitance") > 0:
            yield f"{pin.name} has no capacitance"
    if "cell_leakage_power" not in cell.attributes:
        yield "has no leakage"
    for pin in outputs:
        yield from _arcs(cell, pin, inputs)
        for timing in pin.all("timing"):
            for table in timing.groups:
                yield from _rises(pin.name, timing, table)
    yield from _constraints(cell, inputs)


def _arcs(cell: Group, pin: Group, inputs: dict[str, Group]) -> Iterator[str]:
    """Every input in the function must have a timing arc, the output both edges; a stored value one from its clock."""
    function = pin.text("function")
    needed = _names(function) & set(inputs)
    storage = cell.one("ff") or cell.one("latch")
    if storage and "IQ" in function:
        needed = _names(storage.text("clocked_on") or storage.text("enable"))
    for name in sorted(needed - {timing.text("related_pin") for timing in pin.all("timing")}):
        yield f"{pin.name} has no arc from {name}"
    for name in sorted(_names(pin.text("three_state")) & set(inputs)):
        for kind in ("three_state_enable", "three_state_disable"):
            if not pin.all("timing", related_pin=name, timing_type=kind):
                yield f"{pin.name} has no {kind} from {name}"
    for edge in ("rise", "fall") if inputs else ():
        if not any(t.one(f"cell_{edge}") for t in pin.all("timing")):
            yield f"{pin.name} never has cell_{edge}"


def _rises(name: str, timing: Group, table: Group) -> Iterator[str]:
    values, what = table.array("values"), f"{name} from {timing.text('related_pin')}: {table.kind}"
    if np.ndim(values) != 2 or not np.isfinite(values).all():
        yield f"{what} is no table of numbers"
        return
    falls = np.diff(values, axis=1) < -SLACK * np.maximum(np.abs(values[:, 1:]), 1)
    if falls.any():
        yield f"{what} falls with the load"
    least = 0 if timing.text("timing_type") == "three_state_disable" else 1e-9  # nothing moves then
    if table.kind.endswith("_transition") and (values < least).any():
        yield f"{what} is not above 0"


def _constraints(cell: Group, inputs: dict[str, Group]) -> Iterator[str]:
    """A flip-flop or latch must have setup and hold for what it stores, recovery and removal for set and reset."""
    storage = cell.one("ff") or cell.one("latch")
    if not storage:
        return
    data = storage.text("next_state") or storage.text("data_in")
    forced = f"{storage.text('clear')} {storage.text('preset')}"
    for text, needed in ((data, {"setup", "hold"}), (forced, {"recovery", "removal", "min"})):
        for name in sorted(_names(text) & set(inputs)):
            kinds = {timing.text("timing_type").split("_")[0] for timing in inputs[name].all("timing")}
            for kind in sorted(needed - kinds):
                yield f"{name} has no {'shortest pulse' if kind == 'min' else kind + ' time'}"


def _names(expression: str) -> set[str]:
    return set(re.findall(r"\w+", expression))
