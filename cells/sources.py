"""Sources of the cells of a library: netlist and area of each, abstracts and Verilog of all."""

import json
from collections.abc import Iterable
from pathlib import Path
from types import ModuleType

from talbot.base.lef.write import library as lef_library
from talbot.cells.characterize.job import Source
from talbot.cells.compact.canvas import Canvas
from talbot.cells.compact.catalogue import named
from talbot.cells.compact.library import schematic_spice
from talbot.cells.compact.write import written
from talbot.cells.extract.subcircuit import extract
from talbot.cells.liberty.build import Constant
from talbot.cells.netlist import spice
from talbot.models.parameters import ParameterError
from talbot.platforms.extraction import extraction_platform
from talbot.platforms.sky130 import cells as sky130_hd
from talbot.platforms.sky130 import models as sky130

LIBRARIES = ("sky130_hd", "compact")
NETLISTS = ("extracted", "capacitances", "devices", "schematic")
COMPACT = Path("build/cells/compact")
# cells without an input that hold a constant: cell -> pin: level
CONSTANTS = {"sky130_hd": {"conb_1": {"HI": 1, "LO": 0}}, "compact": {"zero_x1": {"zero": 0}, "one_x1": {"one": 1}}}
_NOT_LOGIC = ("zero_x1", "one_x1", "tie", "diode")


def names(library: str) -> list[str]:
    """Cells of ``library`` that synthesis may use, sorted: of LIBRARIES, or every .subckt of a SPICE file.

    The compact cells are drawn first where their files are missing.
    """
    if library == "sky130_hd":
        return sky130_hd.names()
    if library == "compact":
        return sorted(name for name in _compact_areas() if not name.startswith(_NOT_LOGIC))
    return sorted(spice.read_all(_file(library)))


def left_out(library: str) -> dict[str, str]:
    """Why each of the other cells of ``library`` is not characterized."""
    if library == "sky130_hd":
        return sky130_hd.left_out()
    if library == "compact":
        return {name: "has no input, or no logic" for name in sorted(_compact_areas()) if name.startswith(_NOT_LOGIC)}
    return {}


def title(library: str) -> str:
    """The name of the library's folder and files."""
    return library if library in LIBRARIES else _file(library).stem


def source(library: str, name: str, netlist: str = "extracted") -> Source:
    """The Source of one cell. Raises ParameterError for a cell that is missing.

    netlist: 'extracted' with parasitic capacitances and resistances, 'capacitances' with the former alone, 'devices'
    with the transistors as laid out alone, 'schematic' as the library's own netlist has it.
    """
    if netlist not in NETLISTS:
        raise ParameterError(f"netlist = {netlist!r}: must be one of {', '.join(NETLISTS)}")
    if library not in LIBRARIES:
        return Source(name, spice.subcircuit(spice.source(_file(library)), name), None)
    if library == "compact":
        gds, cell, um2 = COMPACT / "compact.gds", name, _compact_areas()[name]
        schematic = schematic_spice(named(name), Canvas())
    else:
        gds, um2 = sky130_hd.file(name, "gds"), sky130_hd.area(name)
        cell, schematic = gds.stem, sky130_hd.file(name, "spice").read_text(encoding="utf-8")
    if netlist == "schematic":
        return Source(name, schematic, um2)
    capacitors, resistors = netlist in ("extracted", "capacitances"), netlist == "extracted"
    tech = extraction_platform("sky130")
    return Source(name, extract(gds, cell, tech, capacitors=capacitors, resistors=resistors), um2)


def files(library: str, cells: Iterable[str]) -> dict[str, str]:
    """The texts 'lef' and 'v' of ``cells`` (short names) and of those that hold a constant.

    Of the compact library all cells are in them; a SPICE file has neither.
    """
    if library not in LIBRARIES:
        return {}
    if library == "compact":
        return {suffix: (COMPACT / f"compact.{suffix}").read_text(encoding="utf-8") for suffix in ("lef", "v")}
    names = sorted({*cells, *CONSTANTS[library]})
    macros = (sky130_hd.file(name, "lef").read_text(encoding="utf-8") for name in names)
    macros = [text[text.find("MACRO") : text.rfind("END LIBRARY")] for text in macros]
    verilog = "\n".join(sky130_hd.file(name, "functional.v").read_text(encoding="utf-8") for name in names)
    return {"lef": lef_library(*sky130_hd.SITE, macros), "v": verilog}


def constants(library: str) -> dict[str, Constant]:
    """The cells that hold a constant, by whole name."""
    if library not in LIBRARIES:
        return {}
    if library == "compact":
        return {name: Constant(levels, _compact_areas()[name]) for name, levels in CONSTANTS[library].items()}
    held = {name: Constant(levels, sky130_hd.area(name)) for name, levels in CONSTANTS[library].items()}
    return {f"{sky130_hd.LIBRARY}__{name}": constant for name, constant in held.items()}


def process(library: str) -> ModuleType:
    """The module with the transistor models of the library's process."""
    if library not in LIBRARIES:
        _file(library)
    return sky130


def _file(library: str) -> Path:
    """Path of a SPICE file given as library. Raises ParameterError when it is missing."""
    path = Path(library)
    if not path.is_file():
        raise ParameterError(f"library = {library!r}: must be one of {', '.join(LIBRARIES)}, or a SPICE file")
    return path


def _compact_areas() -> dict[str, float]:
    """The um2 of every compact cell; the cells are drawn where the files are missing or other code drew them."""
    written(COMPACT)
    return json.loads((COMPACT / "areas.json").read_text(encoding="utf-8"))
