"""A floorplan's parameters, and the rails that its macros interrupt."""

import pytest

from talbot.flow.layout.steps.floorplan import FloorplanParameters
from talbot.flow.layout.steps.ir_drop import breaks
from talbot.models.parameters import ParameterError


def test_a_macro_outside_the_core_is_refused():
    with pytest.raises(ParameterError, match="macros of one"):
        FloorplanParameters(macros=(("one", "Block", 1.2, 0.0),))


def test_rails_end_beside_a_macro():
    macro = {"x_um": 33.6, "y_um": 0.0, "width_um": 40.0, "height_um": 56.0, "outer": [16.8, 0.0, 95.2, 67.2]}
    assert breaks([macro]) == [(16.8, 0.0, 33.6, 56.0), (73.6, 0.0, 95.2, 56.0)]
