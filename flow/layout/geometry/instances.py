"""Instances of cells in a layout, by the places of a placement."""

from talbot.base.gds import db

from ..netlist.placed import TURNS


def transformation(layout: "db.Layout", x: float, y: float, orientation: str) -> "db.Trans":
    """Of a cell's origin at (x, y), um, in one of Hurricane's orientations."""
    return db.Trans(getattr(db.Trans, TURNS[orientation]), round(x / layout.dbu), round(y / layout.dbu))


def insert(top: "db.Cell", library: "db.Layout", cell: str, x: float, y: float, orientation: str) -> None:
    """Place a ``cell`` in ``top``, drawn as in ``library``, where the layout has no cell of that name."""
    layout = top.layout()
    drawn = layout.cell(cell)
    if drawn is None:
        drawn = layout.create_cell(cell)
        drawn.copy_shapes(library.cell(cell))
    top.insert(db.CellInstArray(drawn.cell_index(), transformation(layout, x, y, orientation)))
