"""Fill keeps its distance, reaches its density where there is room, and what is too dense is found."""

import pytest

from flow.layout.steps.fill import densest, fill
from platforms.coriolis import coriolis_platform

db = pytest.importorskip("klayout.db", reason="klayout: not installed; make layout installs it")


@pytest.fixture(params=["sky130", "ihp-sg13g2"])
def known(request):
    return coriolis_platform(request.param)


def drawn(known, boxes, side=60):
    """(layout, top cell, wire): a die of ``side`` um with ``boxes`` on the second wire."""
    layout, wire = db.Layout(), known.metals[1]
    top = layout.create_cell("top")
    top.shapes(layout.layer(*known.active)).insert(db.DBox(0, 0, side, side))
    for box in boxes:
        top.shapes(layout.layer(*wire.gds)).insert(db.DBox(*box))
    return layout, top, wire


def test_an_empty_layer_gets_its_density(known):
    layout, top, wire = drawn(known, [(10, 10, 50, 10.3)])
    assert fill(layout, top, wire, known.fill) > 100
    assert known.fill.density <= densest(layout, top, wire, known.fill) < known.fill.density + 0.01


def test_squares_keep_their_distance(known):
    layout, top, wire = drawn(known, [(x, 5, x + 0.3, 55) for x in range(5, 50, 7)])
    region = db.Region(top.shapes(layout.layer(*wire.gds)))
    wires = region.dup()
    fill(layout, top, wire, known.fill)
    squares = db.Region(top.shapes(layout.layer(*wire.gds))) - wires
    assert squares.count() > 20
    assert (squares.sized(round(known.fill.clearance_um * 1000) - 1) & wires).is_empty()
    assert squares.space_check(round(known.fill.space_um * 1000)).count() == 0
    assert squares.width_check(round(min(known.fill.sides_um) * 1000)).count() == 0
    assert squares.inside(db.Region(top.bbox())).count() == squares.count()


def test_a_full_layer_gets_nothing_and_is_too_dense(known):
    layout, top, wire = drawn(known, [(0, 0, 60, 45)])
    assert fill(layout, top, wire, known.fill) == 0
    assert densest(layout, top, wire, known.fill) == 0.75 > known.fill.density_most


def test_the_densest_window_counts(known):
    window = known.fill.window_um
    layout, top, wire = drawn(known, [(0, 0, window, window)], side=3 * window)
    assert densest(layout, top, wire, known.fill) == 1.0
