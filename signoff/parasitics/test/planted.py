"""Layouts of a few rectangles, um."""

from talbot.base.gds import db
from talbot.platforms.extraction import extraction_platform
from talbot.platforms.layout import layout_platform
from talbot.signoff.parasitics.shapes import Shapes, shapes

TECH, DEVICES = layout_platform("sky130"), extraction_platform("sky130")
LI, M1, M2, M3 = (metal.gds for metal in TECH.metals[:4])
VIA, VIA2 = (via.gds for via in TECH.vias[1:3])
POLY, CONTACT = TECH.poly, TECH.contact


def layout(*boxes):
    """Layout with the cell 'top' of ``boxes``: (GDS layer, left, bottom, right, top)."""
    made = db.Layout()
    made.dbu = 0.001
    draw(made, made.create_cell("top"), *boxes)
    return made


def draw(made, cell, *boxes):
    for layer, *box in boxes:
        cell.shapes(made.layer(*layer)).insert(db.DBox(*box))


def planted(*boxes) -> Shapes:
    made = layout(*boxes)
    return shapes(made, made.cell("top"), TECH, DEVICES)


def net(found, level, x, y):
    """Number of the net at a point, um; level: LEF name."""
    return int(found.nets[found.at(found.names.index(level), round(x * 1000), round(y * 1000))])
