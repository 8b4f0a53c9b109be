"""Metal too large for its gate is found, except with a diffusion or a short segment."""

import klayout.db as db
import pytest

from talbot.platforms.layout import layout_platform
from talbot.signoff.geometry.antenna import violations
from talbot.signoff.geometry.test.gate import gate

pytestmark = pytest.mark.needs("layout")


@pytest.mark.parametrize("length_um, bad", [(20, 0), (60, 1)])
def test_where_areas_count_thickness_does_not(length_um, bad):
    tech = layout_platform("ihp-sg13g2")
    layout = db.Layout()
    top = layout.create_cell("top")
    m1, m2, via = tech.metals[0], tech.metals[1], tech.vias[0]
    for layer, *box in (
        (tech.active, 0, 0, 1, 0.5),
        (tech.poly, 0.4, -1, 0.53, 1),  # 0.065 um2 of gate
        (tech.contact, 0.4, -0.9, 0.53, -0.8),
        ((m1.layer, 0), 0.3, -1, 0.7, -0.5),
        ((via.layer, 0), 0.4, -0.7, 0.59, -0.51),
        ((m2.layer, 0), 0.3, -0.8, 0.3 + length_um, -0.5),
    ):
        top.shapes(layout.layer(*layer)).insert(db.DBox(*box))
    assert violations(layout, top, tech)[1].count() == bad  # 0.3 um2 a um by 200


@pytest.mark.parametrize(
    "length_um, diffusion, bad", [(5, False, 0), (60, False, 1), (60, True, 0), (300, True, 0), (500, True, 1)]
)
def test_a_long_wire_on_a_gate(length_um, diffusion, bad):
    tech = layout_platform("sky130")
    layout = db.Layout()
    top = layout.create_cell("top")

    def draw(layer, *box):
        top.shapes(layout.layer(*layer)).insert(db.DBox(*box))

    li, m1, mcon = tech.metals[0], tech.metals[1], tech.vias[0]
    draw(tech.active, 0, 0, 1, 0.5)
    draw(tech.poly, 0.4, -1, 0.55, 1)  # a gate of 0.075 um2
    draw(tech.contact, 0.4, -0.9, 0.55, -0.8)
    draw(li.gds, 0.3, -1, 0.7, -0.5)
    draw(mcon.gds, 0.4, -0.7, 0.5, -0.6)
    draw(m1.gds, 0.3, -0.8, 0.3 + length_um, -0.5)  # side walls: 0.7 um2 a um by two
    if diffusion:
        draw(tech.active, 0, -3, 1, -2)
        draw(tech.contact, 0.4, -2.5, 0.5, -2.4)
        draw(li.gds, 0.3, -2.6, 0.7, -0.5)
    assert violations(layout, top, tech)[1].count() == bad
    assert violations(layout, top, tech)[0].is_empty()


@pytest.mark.parametrize("cells", [1, 3])
def test_gates_in_cells_and_the_wire_above(cells):
    """A net through a hierarchy is found as the same net drawn flat is: its metal counts for all its gates."""
    tech = layout_platform("sky130")
    layout = db.Layout()
    top, cell, m1 = layout.create_cell("top"), gate(layout, tech), tech.metals[1]
    for i in range(cells):
        top.insert(db.DCellInstArray(cell.cell_index(), db.DTrans(db.DVector(10 * i, 0))))
    top.shapes(layout.layer(*m1.gds)).insert(db.DBox(0.3, -0.8, 60.3, -0.5))
    hierarchical = violations(layout, top, tech)[1].merged()
    layout.flatten(top.cell_index(), -1, True)
    flat = violations(layout, top, tech)[1].merged()
    assert (hierarchical ^ flat).is_empty() and flat.count() == (cells == 1)
