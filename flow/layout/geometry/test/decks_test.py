"""What is changed of PDKMaster's decks, and a deck that cannot be changed so."""

import pytest

from base.steps import StepError
from flow.layout.geometry.decks import with_flat_spaces
from flow.layout.geometry.lvs_deck import hierarchical

DRC = """deep
nwm = input(64, 20)
both = (nwm&li)
nwm.space(1.27).output(
    "nwm space", "nwm minimum space"
)
both.space(0.2).output(
    "both space", "both minimum space"
)
nwm.width(0.84).output(
    "nwm width", "nwm minimum width"
)
"""
LVS = """schematic(x)
flat
_wafer = extent.sized(0.34)
substrate__Sky130 = (_wafer-nwm)
connect(substrate__Sky130, _wafer)
connect(poly, poly_pin)
"""


def test_spaces_of_drawn_layers_are_checked_flat_and_the_rest_as_before():
    deep, flat = with_flat_spaces(DRC).split("\nflat\n")
    assert "nwm.space" not in deep and "both.space(0.2)" in deep and "nwm.width" in deep
    assert flat == 'nwm = input(64, 20)\nnwm.edges.space(1.27).output(\n    "nwm space", "nwm minimum space"\n)\n'


def test_a_deck_without_spaces_is_refused():
    with pytest.raises(StepError, match="no rule of a space"):
        with_flat_spaces("deep\nnwm = input(64, 20)\n")


def test_the_comparison_goes_by_cells_and_the_substrate_is_one_net():
    assert hierarchical(LVS, (65, 20)).splitlines()[1:5] == [
        "deep",
        "_wafer = input(65, 20)",
        "substrate__Sky130 = (_wafer-nwm)",
        'connect_global(substrate__Sky130, "SUBSTRATE")',
    ]


@pytest.mark.parametrize("line", ["flat", "_wafer = extent.sized(0.34)", "connect(substrate__Sky130, _wafer)"])
def test_a_deck_that_lacks_a_line_is_refused(line):
    with pytest.raises(StepError, match="the deck has 0 lines like"):
        hierarchical(LVS.replace(line + "\n", ""), (65, 20))
