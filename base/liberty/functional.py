"""A Liberty library of areas and functions alone: enough for synthesis by area and for functional Verilog."""

from collections.abc import Iterable, Mapping

from base.liberty.group import Group, Value

UNITS = {
    "time_unit": "1ns",
    "voltage_unit": "1V",
    "current_unit": "1mA",
    "pulling_resistance_unit": "1kohm",
    "leakage_power_unit": "1nW",
    "capacitive_load_unit": (1.0, "pf"),
}


def library(name: str, **attributes: Value) -> Group:
    """An empty library."""
    return Group("library", (name,), {"delay_model": "table_lookup", **attributes})


def add_cell(
    library: Group,
    name: str,
    area: float,
    pins: Iterable[str],
    functions: Mapping[str, str],
    ff: Mapping[str, str] | None = None,
    clock: str = "",
    latch: Mapping[str, str] | None = None,
    **attributes: Value,
) -> Group:
    """Add a cell with its ``area`` (um2) and return it.

    Its ``pins`` are outputs where ``functions`` names them ('' for one without a function), inputs else. ff, latch:
    what the group of a flip-flop (clocked_on, next_state, clear, preset) or a latch (enable, data_in) says; its outputs
    are IQ and IQ_N. clock: the pin that is marked as one.
    """
    cell = library.add("cell", name, area=round(area, 4), **attributes)
    for kind, storage in (("ff", ff), ("latch", latch)):
        if storage:
            cell.add(kind, "IQ", "IQ_N", **storage)
    for pin in pins:
        more: dict[str, Value] = {"function": functions[pin]} if functions.get(pin) else {}
        if pin == clock:
            more["clock"] = True
        cell.add("pin", pin, direction="output" if pin in functions else "input", **more)
    return cell
