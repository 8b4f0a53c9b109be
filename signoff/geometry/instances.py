"""Instances of cells in a layout, by the places of a placement."""

from talbot.base.gds import db
from talbot.signoff.netlist.placed import TURNS


def transformation(layout: "db.Layout", x: float, y: float, orientation: str) -> "db.Trans":
    """Of a cell's origin at (x, y), um, in one of the orientations of `netlist.placed`."""
    return db.Trans(getattr(db.Trans, TURNS[orientation]), round(x / layout.dbu), round(y / layout.dbu))
