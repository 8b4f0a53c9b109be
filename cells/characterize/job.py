"""The characterization of one cell as a job, kept when only the sources of cells change."""

import importlib
import json
from dataclasses import asdict, dataclass
from types import ModuleType

from talbot.base.jobs import Job
from talbot.base.sources import code
from talbot.base.tools import finish
from talbot.cells.characterize.cell import characterize
from talbot.cells.characterize.conditions import Conditions
from talbot.cells.characterize.measured import Measured
from talbot.cells.netlist.check import check
from talbot.cells.netlist.function import Cell, understand
from talbot.cells.netlist.spice import parse


@dataclass(frozen=True)
class Source:
    """A cell: its short name ('nand2_1'), SPICE text, and area in um2 (None without a layout)."""

    name: str
    netlist: str
    area: float | None


def cell_of(source: Source, process: ModuleType) -> Cell:
    """The cell of a Source, checked. Raises ParameterError."""
    netlist = parse(source.netlist, origin=source.name)
    check(netlist, process.POLARITY, process.SUPPLIES)
    return understand(netlist, process.POLARITY, process.SUPPLIES)


def job(source: Source, conditions: Conditions, process: ModuleType) -> Job:
    """The job that characterizes ``source``; its inputs are netlist, conditions, ngspice and code, models too."""
    name, module = f"{source.name}.{conditions.corner.name}.{conditions.models}", process.__name__
    ngspice = finish(["ngspice", "--version"]).stdout
    inputs = source.netlist, json.dumps(asdict(conditions)), code(module), ngspice
    return Job(name, _measure, (source, conditions, module), inputs)


def _measure(source: Source, conditions: Conditions, process: str) -> Measured:
    module = importlib.import_module(process)
    return characterize(cell_of(source, module), module, conditions)
