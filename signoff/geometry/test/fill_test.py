"""Fill keeps its distance, reaches its density where there is room, and what is too dense is found."""

import klayout.db as db
import pytest

from talbot.platforms.layout import layout_platform
from talbot.signoff.geometry.fill import fill, peak_density

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


def test_an_empty_layer_gets_its_density(tech):
    layout, top, metal = drawn(tech, [(10, 10, 50, 10.3)])
    assert fill(layout, top, metal, tech.fill) > 100
    assert tech.fill.density <= peak_density(layout, top, metal, tech.fill) < tech.fill.density + 0.01


def test_squares_keep_their_distance(tech):
    layout, top, metal = drawn(tech, [(x, 5, x + 0.3, 55) for x in range(5, 50, 7)])
    region = db.Region(top.shapes(layout.layer(*metal.gds)))
    routes = region.dup()
    fill(layout, top, metal, tech.fill)
    squares = db.Region(top.shapes(layout.layer(*metal.gds))) - routes
    assert squares.count() > 20
    assert (squares.sized(round(tech.fill.clearance_um * 1000) - 1) & routes).is_empty()
    assert squares.space_check(round(tech.fill.space_um * 1000)).count() == 0
    assert squares.width_check(round(min(tech.fill.sides_um) * 1000)).count() == 0
    assert squares.inside(db.Region(top.bbox())).count() == squares.count()


def test_a_full_layer_gets_nothing_and_is_too_dense(tech):
    layout, top, metal = drawn(tech, [(0, 0, 60, 45)])
    assert fill(layout, top, metal, tech.fill) == 0
    assert peak_density(layout, top, metal, tech.fill) == 0.75 > tech.fill.density_most


def test_the_densest_window_counts(tech):
    window = tech.fill.window_um
    layout, top, metal = drawn(tech, [(0, 0, window, window)], side=3 * window)
    assert peak_density(layout, top, metal, tech.fill) == 1.0
