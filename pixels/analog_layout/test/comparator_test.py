"""The comparator's two halves are mirror images: every mask, but for the crossing of its outputs on the axis."""

import pytest

from talbot.base.gds import db
from talbot.pixels.analog_layout.cells import new_canvas
from talbot.pixels.analog_layout.comparator import comparator_plans, devices
from talbot.pixels.analog_layout.strip import draw_strip
from talbot.pixels.circuits.comparator import ComparatorSizes, comparator
from talbot.platforms.analog import analog_masks

pytestmark = pytest.mark.needs("layout")

MASKS = analog_masks("sky130")
AXIS = 30.0


def halves_differ(mask, half=0.0):
    """Area (um2) in which the drawn strong-arm latch and its mirror image are not the same; half: um of the axis that
    do not count."""
    beside = round((AXIS - half) * 1000), 0, round((AXIS + half) * 1000), 60_000
    plans = comparator_plans(devices(comparator(ComparatorSizes(75.0))), AXIS, (5.0, 55.0))
    canvas = new_canvas(MASKS, "arm")
    draw_strip(canvas, MASKS, plans[0], 0.0)
    shapes = db.Region(canvas.cell.shapes(canvas.layout.layer(*mask))).merged()
    kept = db.Region(db.Box(0, 0, 60_000, 60_000)) - db.Region(db.Box(*beside))
    shapes &= kept
    turned = shapes.transformed(db.Trans(db.Trans.M90, round(2 * AXIS * 1000), 0))
    return (shapes ^ turned).area() * 1e-6


@pytest.mark.parametrize("name", ["active", "well", "nplus", "pplus", "poly", "contact", "contact_poly"])
def test_devices_are_mirror_images(name):
    assert halves_differ(getattr(MASKS.base, name)) == 0


def test_wires_are_mirror_images_but_for_the_crossing():
    masks = [metal.gds for metal in MASKS.base.metals[:5]] + [via.gds for via in MASKS.base.vias[:4]]
    assert [halves_differ(mask, 1.5) for mask in masks] == [0] * len(masks)
    assert [halves_differ(mask) for mask in masks[:3]] == [0] * 3
    assert 0 < halves_differ(MASKS.base.metals[3].gds) < 2
