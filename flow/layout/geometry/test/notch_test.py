"""A slit in one shape is filled, a gap between two is left for the rules to find, and a wide slit stays."""

import klayout.db as db
import pytest

from talbot.flow.layout.geometry import notch
from talbot.platforms.coriolis import coriolis_platform

pytestmark = pytest.mark.needs("layout")
METAL = coriolis_platform("sky130").metals[1]


def filled(*boxes):
    """(how many slits were filled, the metal after that) of boxes in nm."""
    layout = db.Layout()
    top = layout.create_cell("top")
    shapes = top.shapes(layout.layer(*METAL.gds))
    for box in boxes:
        shapes.insert(db.Box(*box))
    return notch.fill(layout, top, (METAL,), {METAL.name: 0.14}), db.Region(shapes).merged()


def test_the_slit_beside_a_pad_is_filled():
    pad, pin = (254_840, 92_790, 255_160, 93_050), (255_200, 92_760, 256_800, 93_080)
    segment = (254_930, 92_850, 255_325, 92_990)
    count, metal = filled(pad, pin, segment)
    assert count == 2
    assert metal.space_check(140, False, db.Region.Projection).is_empty()
    assert metal.area() == sum(db.Region(db.Box(*box)).area() for box in (pad, pin)) + 40 * 260


@pytest.mark.parametrize("side, holes", [(360, 0), (380, 1)])
def test_a_small_hole_is_filled(side, holes):
    """0.14 um2 is 374 nm square; the hole is wider than a slit."""
    ring = [
        (0, 0, 1000, 140),
        (0, 140 + side, 1000, 280 + side),
        (0, 0, 140, 280 + side),
        (140 + side, 0, 1000, 280 + side),
    ]
    count, metal = filled(*ring)
    assert (count, metal.holes().count()) == (1 - holes, holes)


def test_two_shapes_stay_two():
    assert filled((0, 0, 320, 320), (360, 0, 700, 320))[0] == 0


def test_a_slit_as_wide_as_allowed_stays():
    assert filled((0, 0, 320, 320), (460, 0, 800, 320), (0, 0, 800, 140))[0] == 0
