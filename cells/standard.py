"""The cells that layouts are made of, process by process."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any

from talbot.base.gds import write_gds
from talbot.cells.compact.library import library
from talbot.cells.compact.write import BLOCKAGES, export_gds, exported
from talbot.platforms.coriolis import coriolis_platform
from talbot.platforms.processes import package

COMPACT = ("sky130",)  # the processes that cells.compact draws for


@dataclass(frozen=True)
class StandardCells:
    """A PDKMaster library, all layouts drawn; what writes its GDS; a module of Coriolis that completes it, or ''."""

    library: Any
    write_gds: Callable[[Path], None]
    fix: str = ""


def standard_cells(pdk: str, store: Path) -> StandardCells:
    """The cells of ``pdk``: those of cells.compact where they are drawn for it, else c4m-flexcell's.

    Raises ParameterError. store: folder of the drawn cells.
    """
    if pdk in COMPACT:
        made = library(store=store)
        return StandardCells(made, partial(export_gds, made), BLOCKAGES)
    tech = coriolis_platform(pdk)
    made = import_module(f"talbot.platforms.{package(pdk)}.coriolis").library()
    gds_layers = import_module(f"{tech.package}.pdkmaster").gds_layers
    return StandardCells(made, lambda path: write_gds(exported(made, gds_layers), path))
