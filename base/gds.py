"""GDS as every step writes it, the same layout as the same file; and KLayout's database, loaded at its first use."""

import importlib
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import klayout.db as db
else:

    class _Database:
        """The module klayout.db: an option of the installation, which modules import without."""

        def __getattr__(self, name: str) -> Any:
            setattr(self, name, getattr(importlib.import_module("klayout.db"), name))
            return self.__dict__[name]

    db = _Database()


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
