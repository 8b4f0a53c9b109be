"""A small DEF as it leaves OpenROAD, merged with two cells of the wheel, and what the GDS then holds."""

import klayout.db as db
import pytest

from talbot.models.parameters import ParameterError
from talbot.platforms.openroad import openroad_platform
from talbot.platforms.sky130 import cells as sky130_hd
from talbot.signoff.geometry.merge import merge

pytestmark = pytest.mark.needs("layout")
KNOWN = openroad_platform("sky130")
DEF = """VERSION 5.8 ;
DIVIDERCHAR "/" ;
BUSBITCHARS "[]" ;
DESIGN two ;
UNITS DISTANCE MICRONS 1000 ;
DIEAREA ( 0 0 ) ( 10000 8000 ) ;
COMPONENTS 2 ;
 - a sky130_fd_sc_hd__inv_1 + PLACED ( 0 0 ) N ;
 - b sky130_fd_sc_hd__nand2_1 + PLACED ( 2300 2720 ) FS ;
END COMPONENTS
PINS 1 ;
 - x + NET x + DIRECTION INPUT + USE SIGNAL + PORT + LAYER met2 ( -140 -140 ) ( 140 140 ) + PLACED ( 5000 140 ) N ;
END PINS
NETS 1 ;
 - x ( PIN x ) ( a A ) + ROUTED met2 ( 5000 140 ) ( 5000 4000 ) NEW met1 ( 5000 4000 ) ( 2000 4000 ) ;
END NETS
END DESIGN
"""


@pytest.fixture
def merged(tmp_path):
    """merged(cells): the GDS as a Layout, made with a library of these cells."""
    lefs = [
        sky130_hd.folder() / "tech" / "sky130_fd_sc_hd__nom.tlef",
        *(sky130_hd.file(cell, "lef") for cell in ("inv_1", "nand2_1")),
    ]

    def make(*cells):
        library = db.Layout()
        for cell in cells:
            library.read(str(sky130_hd.file(cell, "gds")))
        library.write(str(tmp_path / "cells.gds"))
        (tmp_path / "two.def").write_text(DEF)
        box = merge(tmp_path / "two.def", lefs, tmp_path / "cells.gds", KNOWN, tmp_path / "two.gds")
        assert box == (10.0, 8.0)
        layout = db.Layout()
        layout.read(str(tmp_path / "two.gds"))
        return layout

    return make


def test_cells_wires_pins_and_labels_lie_where_they_belong(merged):
    layout = merged("inv_1", "nand2_1")
    top = layout.top_cell()
    placed = {i.cell.name: (i.trans.disp.x, i.trans.disp.y, i.trans.is_mirror()) for i in top.each_inst()}
    assert placed == {"sky130_fd_sc_hd__inv_1": (0, 0, False), "sky130_fd_sc_hd__nand2_1": (2300, 5440, True)}

    def region(layer, datatype):
        return db.Region(top.shapes(layout.layer(layer, datatype)))

    assert region(68, 20).bbox() == db.Box(1930, 3930, 5070, 4070)
    assert region(69, 16).bbox() == db.Box(4860, 0, 5140, 280)
    assert [shape.text_string for shape in top.shapes(layout.layer(69, 5)).each(db.Shapes.STexts)] == ["x"]
    assert not layout.cell("sky130_fd_sc_hd__inv_1").bbox(layout.layer(66, 20)).empty()  # a gate: GDS, not LEF


def test_a_cell_without_layout_is_named(merged):
    with pytest.raises(ParameterError, match="must have the cell sky130_fd_sc_hd__nand2_1"):
        merged("inv_1")
