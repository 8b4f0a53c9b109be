"""The characterization of one cell as a job: apart from where cells come from, so that it is kept when that changes."""

import importlib
import json
from dataclasses import asdict, dataclass

from base import jobs
from base.sources import code
from base.tools import finish
from cells.netlist.check import check
from cells.netlist.function import understand
from cells.netlist.spice import parse

from .cell import characterize


@dataclass(frozen=True)
class Source:
    """name: short ('nand2_1'). netlist: SPICE text; area: um2, or None where no layout says it."""

    name: str
    netlist: str
    area: float | None


def cell_of(source, process):
    """Cell of a Source, checked. Raises ParameterError."""
    netlist = parse(source.netlist, origin=source.name)
    check(netlist, process.POLARITY, process.SUPPLIES)
    return understand(netlist, process.POLARITY, process.SUPPLIES)


def job(source, conditions, process):
    """The job that characterizes ``source``; another netlist, corner, setting, model, ngspice or code is another."""
    name = f"{source.name}.{conditions.corner.name}.{conditions.models}"
    return jobs.Job(
        name,
        _measure,
        (source, conditions, process.__name__),
        (
            source.netlist,
            json.dumps(asdict(conditions)),
            code(process.__name__),
            finish(["ngspice", "--version"]).stdout,
        ),
    )


def _measure(source, conditions, process):
    module = importlib.import_module(process)
    return characterize(cell_of(source, module), module, conditions)
