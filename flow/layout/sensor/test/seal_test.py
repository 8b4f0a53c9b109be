"""The seal ring: every layer is closed, as wide at the chamfers as on the sides, and off everything else."""

import math

import pytest

from talbot.base.gds import db
from talbot.flow.layout.sensor import seal
from talbot.flow.layout.sensor.plan import DieParameters
from talbot.platforms.die import seal_ring
from talbot.platforms.layout import layout_platform
from talbot.platforms.pads import pad_process
from talbot.platforms.sky130.layers import LICON, METALS, TAP, VIAS

pytestmark = pytest.mark.needs("layout")
RULES = seal_ring("sky130")


@pytest.fixture(params=[(2300.0, 2260.0), (4840.0, 5560.01)])
def ring(request):
    """(layout, its cell, width, height)."""
    layout = db.Layout()
    layout.dbu = 0.001
    return layout, seal.draw(layout, *request.param, RULES, layout_platform("sky130").grid_um), *request.param


def region(layout, cell, gds):
    """What is drawn on a layer, merged."""
    return db.Region(cell.begin_shapes_rec(layout.layer(*gds))).merged()


def test_every_layer_is_closed_and_on_the_grid(ring):
    layout, cell, width, height = ring
    walls = [via.gds for via in VIAS]
    for gds in (TAP, *(metal.gds for metal in METALS), *walls):
        drawn = region(layout, cell, gds)
        polygons = list(drawn.each())
        assert len(polygons) == (2 if gds in walls else 1)
        for polygon in polygons:
            assert polygon.holes() == 1
            assert polygon.bbox().to_dtype(layout.dbu).center() == db.DPoint(width / 2, height / 2)
        assert drawn.grid_check(5, 5).is_empty()


def directed(points):
    """The edges of a polygon by direction."""
    return sorted(db.Polygon(list(points)).each_edge(), key=lambda edge: math.atan2(edge.dy(), edge.dx()))


@pytest.mark.parametrize("via", VIAS)
def test_walls_are_as_wide_as_a_cut_at_the_chamfers_too(ring, via):
    """Rules of SkyWater's deck, um: 0.17 to 0.175 of mcon, 0.2 to 0.205 of via to via3, 0.8 to 0.805 of via4."""
    layout, cell, *_ = ring
    least = {"mcon": 170, "via4": 800}.get(via.name, 200)
    drawn = region(layout, cell, via.gds)
    assert drawn.width_check(least).is_empty()
    for polygon in drawn.each():
        outside, inside = directed(polygon.each_point_hull()), directed(polygon.each_point_hole(0))
        assert len(outside) == len(inside) == 8
        gaps = [abs(edge.distance(hole.p1)) for edge, hole in zip(outside, inside, strict=True)]
        assert least <= min(gaps) and max(gaps) < least + 5


def test_contacts_are_squares_a_width_apart(ring):
    layout, cell, width, height = ring
    drawn = region(layout, cell, LICON.gds)
    assert drawn.count() == pytest.approx(2 * 2 * (width + height - 4 * 19) / 0.34, rel=0.01)
    assert all(square.is_box() and square.bbox().width() == square.bbox().height() == 170 for square in drawn.each())
    assert drawn.space_check(170).is_empty()


def test_a_cut_is_inside_of_what_it_joins(ring):
    layout, cell, *_ = ring
    conductors = [TAP, *(metal.gds for metal in METALS)]
    for cut, low, high in zip((LICON, *VIAS), conductors, conductors[1:], strict=False):
        for gds in (low, high):
            assert (region(layout, cell, cut.gds).sized(310) - region(layout, cell, gds)).is_empty()


def test_it_ends_before_the_pads(ring):
    layout, cell, width, height = ring
    edge = DieParameters().ring_um - pad_process("sky130").height_um
    inside = db.Region(db.DBox(edge, edge, width - edge, height - edge).to_itype(layout.dbu))
    for gds in {wall.gds for wall in (*RULES.rings, *RULES.contacts)}:
        assert (region(layout, cell, gds).sized(2000) & inside).is_empty(), gds
