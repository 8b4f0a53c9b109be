"""The cells that layouts are made of, process by process."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from talbot.cells.compact.library import library
from talbot.cells.compact.write import export_gds
from talbot.platforms.processes import package

COMPACT = ("sky130",)  # the processes that cells.compact draws for


@dataclass(frozen=True)
class StandardCells:
    """A PDKMaster library, all layouts drawn, and what writes its GDS."""

    library: Any
    write_gds: Callable[[Path], None]


def standard_cells(pdk: str, store: Path) -> StandardCells:
    """The cells of ``pdk``, those of cells.compact. Raises ParameterError. store: folder of the drawn cells."""
    package(pdk, COMPACT, " with cells of cells.compact")
    cells_library = library(store=store)
    return StandardCells(cells_library, partial(export_gds, cells_library))
