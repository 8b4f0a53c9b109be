"""A pad too small grows where there is room, and stays where there is none."""

import klayout.db as db
import pytest

from talbot.flow.layout.geometry.area import grow
from talbot.platforms.coriolis import coriolis_platform

pytestmark = pytest.mark.needs("layout")
RULES = {"area": 0.144, "space": 0.21}


@pytest.fixture
def tech():
    return coriolis_platform("ihp-sg13g2")


def metal(tech, boxes):
    """(how many grew, Region after that) of ``boxes`` (um) on the second layer."""
    layout, layer = db.Layout(), tech.metals[1]
    top = layout.create_cell("top")
    for box in boxes:
        top.shapes(layout.layer(*layer.gds)).insert(db.DBox(*box))
    count = grow(layout, top, [layer], {layer.name: RULES})
    return count, db.Region(top.begin_shapes_rec(layout.layer(*layer.gds))).merged()


def test_a_pad_alone_grows_to_the_least_area(tech):
    count, found = metal(tech, [(0, 0, 0.29, 0.29), (5, 0, 6, 0.3)])
    assert count == 1
    assert found.with_area(0, 144_000, False).count() == 0 and found.area() < 145_500 + 300_000


def test_it_grows_away_from_its_neighbours(tech):
    near = [(0.55, -1, 0.85, 1), (-0.9, -1, -0.6, 1)]
    count, found = metal(tech, [(0, 0, 0.29, 0.29), *near])
    assert count == 1 and found.count() == 3
    assert found.space_check(210).count() == 0


def test_between_two_tracks_it_grows_along_them(tech):
    count, found = metal(tech, [(0, 0, 0.29, 0.29), (0.5, -2, 0.7, 2), (-0.5, -2, -0.21, 2)])
    assert count == 1 and found.space_check(210).count() == 0 and found.with_area(0, 144_000, False).count() == 0


def test_one_without_room_stays(tech):
    ring = [(-1, -1, 1.3, -0.25), (-1, 0.54, 1.3, 1.3), (-1, -1, -0.25, 1.3), (0.54, -1, 1.3, 1.3)]
    count, found = metal(tech, [(0, 0, 0.29, 0.29), *ring])
    assert count == 0 and found.with_area(0, 144_000, False).count() == 1


def test_what_is_large_enough_is_let_alone(tech):
    assert metal(tech, [(0, 0, 0.38, 0.38), (0.7, 0, 0.9, 3)])[0] == 0
