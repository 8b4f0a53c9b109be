"""A Liberty file of areas and functions alone, without delays.

The functions are those of the transistors as laid out, not those that names promise: c4m-flexcell 0.4.7's nexor2_x0
is an exclusive or.
"""

from collections.abc import Iterable, Mapping
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, NamedTuple

from talbot.base.liberty.functional import add_cell, library
from talbot.base.liberty.write import text

if TYPE_CHECKING:
    from talbot.cells.netlist.function import Storage
    from talbot.platforms.extraction import ExtractionPlatform

CONSTANTS = {"zero": "0", "one": "1"}


class Function(NamedTuple):
    """What a cell does: the expression of every output, and its storage."""

    outputs: dict[str, str]
    storage: "Storage | None"


def functions(gds: Path, names: Iterable[str], models: ModuleType, tech: "ExtractionPlatform") -> dict[str, Function]:
    """Functions of the cells ``names`` in ``gds``; cells without an output are left out. models: `device_models`."""
    from talbot.cells.extract.subcircuit import extract
    from talbot.cells.netlist.function import understand
    from talbot.cells.netlist.spice import parse

    found = {}
    for name in names:
        netlist = parse(extract(gds, name, tech, capacitors=False, resistors=False), origin=name)
        constant = {pin: CONSTANTS[pin] for pin in netlist.ports if pin in CONSTANTS}
        if constant:
            found[name] = Function(constant, None)
            continue
        cell = understand(netlist, models.POLARITY, models.SUPPLIES)
        if cell.functions:
            found[name] = Function(cell.functions, cell.storage)
    return found


def liberty(cells: Mapping[str, Function], ports: Mapping[str, Iterable[str]], areas: Mapping[str, float]) -> str:
    """Text of the Liberty file of ``cells`` without latches. ports: pins without supplies; areas: um2."""
    from talbot.cells.liberty.build import gating, storage_attributes

    made = library("cells")
    for name, (outputs, storage) in cells.items():
        inside = storage_attributes(storage) if storage else None
        if storage and storage.kind == "gate":
            cell = add_cell(made, name, areas[name], ports[name], outputs, latch=inside)
            cell.attributes["clock_gating_integrated_cell"] = gating(storage)
        else:
            add_cell(made, name, areas[name], ports[name], outputs, inside)
    return text(made)
