"""Where the cells of a library come from: netlist, layout, abstract and Verilog of each."""

import re
from dataclasses import dataclass
from pathlib import Path

from cells.extract import extract
from flow.platforms.sky130 import cells as sky130_hd
from flow.platforms.sky130 import models as sky130
from flow.platforms.sky130 import process as sky130_layout
from models.parameters import ParameterError

LIBRARIES = ("sky130_hd", "flexcell")
NETLISTS = ("extracted", "devices", "schematic")


@dataclass(frozen=True)
class Source:
    """name: short ('nand2_1'). netlist: SPICE text; lef, verilog: text; area: um2."""

    name: str
    netlist: str
    lef: str
    verilog: str
    area: float


def names(library):
    """Cells of ``library`` that synthesis may use, sorted."""
    if library == "sky130_hd":
        return sky130_hd.names()
    if library == "flexcell":
        from cells.flexcell import library as flexcell
        return flexcell.names()
    raise ParameterError(f"library = {library!r}: must be one of {', '.join(LIBRARIES)}")


def source(library, name, netlist="extracted"):
    """Source of one cell. netlist: 'extracted' with stray capacitances, 'devices' with the transistors as laid out

    alone, 'schematic' as the library's own netlist has it. Raises ParameterError for a cell that is not there.
    """
    if netlist not in NETLISTS:
        raise ParameterError(f"netlist = {netlist!r}: must be one of {', '.join(NETLISTS)}")
    if library == "flexcell":
        from cells.flexcell import library as flexcell
        return flexcell.source(name, netlist)
    files = {kind: sky130_hd.file(name, kind) for kind in ("gds", "spice", "lef", "v")}
    text = (Path(files["spice"]).read_text() if netlist == "schematic" else
            extract(files["gds"], files["gds"].stem, sky130_layout, strays=netlist == "extracted"))
    lef = files["lef"].read_text()
    return Source(name, text, lef, sky130_hd.file(name, "functional.v").read_text(), area(lef))


def area(lef):
    """um2 of a LEF macro's SIZE."""
    width, height = map(float, re.search(r"SIZE\s+([0-9.]+)\s+BY\s+([0-9.]+)", lef).groups())
    return width * height


def process(library):
    """Module with the models of the process that ``library`` is made in."""
    if library not in LIBRARIES:
        raise ParameterError(f"library = {library!r}: must be one of {', '.join(LIBRARIES)}")
    return sky130
