"""GDS as every step writes it: the same layout is the same file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import klayout.db as db


def write_gds(layout: db.Layout, path: Path, top: db.Cell | None = None) -> None:
    """Write ``layout`` to the file ``path`` with no time stamp; top: only this cell and what is below it."""
    import klayout.db as db

    options = db.SaveLayoutOptions()
    options.gds2_write_timestamps = False
    if top:
        options.select_cell(top.cell_index())
    layout.write(str(path), options)
