"""GDS as every step writes it, the same layout as the same file; and KLayout's modules, loaded at their first use."""

import importlib
from pathlib import Path
from typing import TYPE_CHECKING, Any


class _Module:
    """A module of KLayout: an option of the installation, which modules import without."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __getattr__(self, name: str) -> Any:
        setattr(self, name, getattr(importlib.import_module(self._name), name))
        return self.__dict__[name]


if TYPE_CHECKING:
    import klayout.db as db
else:
    db = _Module("klayout.db")
pex = _Module("klayout.pex")  # KLayout's types leave out its classes


def read_gds(path: Path) -> "db.Layout":
    """Read a file, GDS or LEF."""
    layout = db.Layout()
    layout.read(str(path))
    return layout


def write_gds(layout: "db.Layout", path: Path, top: "db.Cell | None" = None) -> None:
    """Write ``layout`` to the file ``path`` with no time stamp; top: only this cell and what is below it."""
    options = db.SaveLayoutOptions()
    options.gds2_write_timestamps = False
    if top:
        options.select_cell(top.cell_index())
    layout.write(str(path), options)
