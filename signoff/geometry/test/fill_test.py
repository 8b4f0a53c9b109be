"""Fill keeps its distance, reaches its density where there is room, and what is too dense is found."""

from dataclasses import replace
from itertools import pairwise

import klayout.db as db
import pytest

from talbot.platforms.layout import layout_platform
from talbot.signoff.geometry.fill import densities, fill, fill_cells

pytestmark = pytest.mark.needs("layout")


@pytest.fixture(params=["sky130", "ihp-sg13g2"])
def tech(request):
    return layout_platform(request.param)


def drawn(tech, boxes, side=60):
    """(layout, top cell, metal): a die of ``side`` um with ``boxes`` on the second layer."""
    layout, metal = db.Layout(), tech.metals[1]
    top = layout.create_cell("top")
    top.shapes(layout.layer(*tech.active)).insert(db.DBox(0, 0, side, side))
    for box in boxes:
        top.shapes(layout.layer(*metal.gds)).insert(db.DBox(*box))
    return layout, top, metal


def density(layout, top, metal, tech):
    return densities(layout, top, [metal.gds], tech.fill.window_um)


def test_an_empty_layer_gets_its_density(tech):
    layout, top, metal = drawn(tech, [(10, 10, 50, 10.3)])
    assert fill(layout, top, metal, tech.fill) > 100
    least, most = density(layout, top, metal, tech)
    assert tech.fill.density_least < least == most < tech.fill.density + 0.01


@pytest.mark.parametrize("gap", [1.0, 1.45, 2.2, 7.0])
def test_shapes_keep_their_distance_and_width(tech, gap):
    """Where routes are near the clearance shrinks, to the smallest and no further."""
    starts = [5 + (0.3 + gap) * k for k in range(int(50 / (0.3 + gap)))]
    layout, top, metal = drawn(tech, [(x, 5, x + 0.3, 55 - x / 7) for x in starts])
    region = db.Region(top.shapes(layout.layer(*metal.gds)))
    routes, rules = region.dup(), tech.fill
    fill(layout, top, metal, rules)
    shapes = db.Region(top.shapes(layout.layer(*metal.gds))) - routes
    space = round(1000 * min(rules.clearances_um[metal.name]))
    assert shapes.count() > 20
    assert (shapes.sized(space - 1) & routes).is_empty()
    assert shapes.space_check(space).count() == shapes.notch_check(space).count() == 0
    assert shapes.width_check(round(1000 * rules.width_um)).count() == 0
    assert min(shape.area() for shape in shapes.each()) >= 1e6 * rules.area_um2
    assert shapes.inside(db.Region(top.bbox())).count() == shapes.count()


def test_room_that_meets_at_a_corner_is_not_filled_up_to_it(tech):
    far = tech.fill.clearances_um[tech.metals[1].name][0]
    layout, top, metal = drawn(tech, [(18, 30 + far, 30 - far, 42), (30 + far, 18, 42, 30 - far)])
    fill(layout, top, metal, replace(tech.fill, density=1.0))
    region = db.Region(top.shapes(layout.layer(*metal.gds)))
    assert region.count() > 20
    assert region.width_check(250).count() == region.space_check(200).count() == 0


def test_the_largest_clearance_comes_first(tech):
    largest, *_, smallest = tech.fill.clearances_um[tech.metals[1].name]
    layout, top, metal = drawn(tech, [(10, 0, 10.3, 60)])
    routes = db.Region(top.shapes(layout.layer(*metal.gds))).dup()
    fill(layout, top, metal, tech.fill)
    shapes = db.Region(top.shapes(layout.layer(*metal.gds))) - routes
    assert smallest < largest
    assert (shapes & routes.sized(round(1000 * largest) - 1)).is_empty()


def test_a_full_layer_gets_nothing_and_is_too_dense(tech):
    layout, top, metal = drawn(tech, [(0, 0, 60, 45)])
    assert fill(layout, top, metal, tech.fill) == 0
    assert density(layout, top, metal, tech) == (0.75, 0.75)
    assert tech.fill.density_most < 0.75


def test_the_emptiest_and_the_densest_window_count(tech):
    window = tech.fill.window_um
    layout, top, metal = drawn(tech, [(0, 0, window, window)], side=3 * window)
    assert density(layout, top, metal, tech) == (0.0, 1.0)


def test_filler_cells_get_diffusion_and_local_interconnect():
    """Two rows of implants at 0.27..1.04 and 2.015..2.85 um hold shapes; the implant around a tap does not."""
    tech = layout_platform("sky130")
    layout = db.Layout()
    filler, gate = layout.create_cell(tech.fill_cells[0]), layout.create_cell("inv_x1")
    for cell in (filler, gate):
        for implant, (low, high) in zip(tech.dummies.implants, [(0.27, 1.04), (2.015, 2.85)], strict=True):
            cell.shapes(layout.layer(*implant)).insert(db.DBox(-0.13, low, 2.21, high))
        cell.shapes(layout.layer(*tech.dummies.implants[0])).insert(db.DBox(-0.13, 2.86, 2.21, 3.38))
        cell.shapes(layout.layer(*tech.dummies.taps)).insert(db.DBox(0, 2.995, 2.08, 3.245))
    fill_cells(layout, tech.fill_cells, tech.dummies)
    diffusion = [shape.dbbox() for shape in filler.shapes(layout.layer(*tech.active)).each()]
    assert sorted(diffusion, key=lambda box: box.bottom) == [
        db.DBox(0.135, 0.395, 1.945, 0.915),
        db.DBox(0.135, 2.14, 1.945, 2.725),
    ]
    assert gate.shapes(layout.layer(*tech.active)).is_empty()
    assert filler.shapes(layout.layer(*tech.metals[0].gds)).size() == 2


def test_clearances_fall(tech):
    for clearances in tech.fill.clearances_um.values():
        assert all(a > b for a, b in pairwise(clearances))
