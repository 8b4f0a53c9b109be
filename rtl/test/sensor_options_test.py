"""The export's options of a sensor: those of its fields that are not the standard's, and the sensor of them again."""

from dataclasses import replace

import pytest

from talbot.models.parameters import STANDARD, ArrayParameters, ChipParameters, ParameterError, TileParameters
from talbot.rtl.sensor_options import FIELDS, options_of, sensor_with

ODD = replace(
    STANDARD,
    array=ArrayParameters(40, 60),
    tile=TileParameters.small(2, 3),
    chip=ChipParameters(lanes=1, divider="cordic", n_frac=6, cordic_iterations=7),
)


def test_the_standard_sensor_needs_no_option():
    assert options_of(STANDARD) == () and sensor_with(()) == STANDARD


def test_a_sensor_is_that_of_its_options():
    options = options_of(ODD)
    assert "--rows=40" in options and "--order=0,3,5,2,1,4" in options and len(options) == len(FIELDS)
    assert sensor_with(options) == ODD


def test_another_order_alone():
    turned = replace(STANDARD, tile=replace(STANDARD.tile, order=tuple(reversed(range(24)))))
    assert sensor_with(options_of(turned)) == turned


def test_bad_input():
    with pytest.raises(ParameterError, match="rows = 0: must be an integer in 1..1024"):
        sensor_with(("--rows=0",))
