"""The comparator's two halves are mirror images: every mask but the vias to the tracks."""

from importlib.util import find_spec

import pytest

if find_spec("klayout") is None:
    pytest.skip("klayout: not installed", allow_module_level=True)

from talbot.base.gds import db
from talbot.pixels.analog_layout.cells import new_canvas
from talbot.pixels.analog_layout.comparator import comparator_plans, devices
from talbot.pixels.analog_layout.strip import draw_strip
from talbot.pixels.circuits.comparator import ComparatorSizes, comparator
from talbot.platforms.analog import analog_masks

MASKS = analog_masks("sky130")
AXIS = 30.0


def halves_differ(mask):
    """Area (um2) in which the drawn strong-arm latch and its mirror image are not the same."""
    plans = comparator_plans(devices(comparator(ComparatorSizes(75.0))), AXIS, (5.0, 55.0))
    canvas = new_canvas(MASKS, "arm")
    draw_strip(canvas, MASKS, plans[0], 0.0)
    shapes = db.Region(canvas.cell.shapes(canvas.layout.layer(*mask))).merged()
    turned = shapes.transformed(db.Trans(db.Trans.M90, round(2 * AXIS * 1000), 0))
    return (shapes ^ turned).area() * 1e-6


@pytest.mark.parametrize("name", ["active", "well", "nplus", "pplus", "poly", "contact", "contact_poly"])
def test_devices_are_mirror_images(name):
    assert halves_differ(getattr(MASKS.base, name)) == 0


def test_wires_are_mirror_images_and_only_the_vias_to_the_tracks_swap():
    base = MASKS.base
    assert [halves_differ(base.metals[level].gds) for level in range(3)] == [0, 0, 0]
    assert [halves_differ(base.vias[level].gds) for level in range(2)] == [0, 0]
    assert halves_differ(base.metals[3].gds) < 0.1  # pads of the vias beside the tracks
    assert halves_differ(base.vias[2].gds) > 0
