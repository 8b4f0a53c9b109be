"""The leaves of the clock tree."""

import pytest

from talbot.flow.layout.netlist.netlist import Instance, Netlist
from talbot.flow.layout.steps.place import LEAF_SINKS, Place, PlaceParameters


@pytest.mark.parametrize("width, height", ((200.0, 200.0), (150.0, 220.0), (220.0, 150.0)))
def test_a_core_with_sinks_for_four_leaves_can_be_quartered(width, height):
    """Coriolis does so where both sides are at least twice a leaf's."""
    plan = {"width_um": width, "height_um": height, "tree": [0.0, 0.0, width, height]}
    sides = [
        Place(PlaceParameters()).leaf_um(
            plan, Netlist("", (), tuple(Instance(f"r{k}", "dff_x1", {"clk": "clk"}) for k in range(count)))
        )
        for count in (4 * LEAF_SINKS + 1, 4 * LEAF_SINKS - 1)
    ]
    assert 2 * sides[0] <= min(width, height) < 2 * sides[1]
