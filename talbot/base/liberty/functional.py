"""A Liberty library of areas and functions alone: enough for synthesis by area and for functional Verilog."""

from collections.abc import Iterable, Mapping

from talbot.base.liberty.group import Group, Value

UNITS = {
    "time_unit": "1ns",
    "voltage_unit": "1V",
    "current_unit": "1mA",
    "pulling_resistance_unit": "1kohm",
    "leakage_power_unit": "1nW",
    "capacitive_load_unit": (1.0, "pf"),
}


def library(name: str, **attributes: Value) -> Group:
    """Return an empty library."""
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


def with_latches(library: Group) -> Group:
    """Give the clock gates of ``library`` a latch and a function instead of a state table, which Yosys does not read.

    Of those that Liberty calls latch_posedge: a latch, open while the clock is low, and an AND. Changes and returns it.
    """
    for cell in library.all("cell", clock_gating_integrated_cell="latch_posedge"):
        if cell.one("latch"):
            continue
        roles = ("enable", "clock", "out")
        pins = {role: pin for pin in cell.all("pin") for role in roles if pin.text(f"clock_gate_{role}_pin") == "true"}
        cell.groups = [g for g in cell.groups if g.kind != "statetable" and g.text("direction") != "internal"]
        cell.add("latch", "IQ", "IQ_N", enable=f"!{pins['clock'].name}", data_in=pins["enable"].name)
        pins["out"].attributes["function"] = f"{pins['clock'].name} & IQ"
    return library
