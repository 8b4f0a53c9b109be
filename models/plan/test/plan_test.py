"""What a plan reads, what it leaves out and why."""

import numpy as np
import pytest

from talbot.models.parameters import ArrayParameters, FrameParameters, ParameterError, SensorParameters, Window
from talbot.models.plan import plan
from talbot.models.scene import Sampling, load

ROWS, COLS = 38, 62
SENSOR = SensorParameters(array=ArrayParameters(ROWS, COLS))
FULL = SENSOR.full_window


def _scene(name, **sampling):
    return load(name, Sampling(ROWS, COLS, **sampling))


def _what(made):
    return {entry.what for entry in made.left_out}


def test_decimation_reads_every_second_tile():
    made = plan(_scene("flat"), SENSOR, FrameParameters(FULL, decimation=1))
    tiles = made.read[::4, ::6]
    np.testing.assert_array_equal(np.argwhere(tiles) % 2, 0)


def test_other_modes_capture_once():
    made = plan(_scene("motorcycle"), SENSOR, FrameParameters(FULL, mode="image"))
    assert (made.taps, made.captures) == (1, 1) and "time-of-flight taps" in _what(made)


def test_impossible_window():
    with pytest.raises(ParameterError, match="window"):
        plan(_scene("flat"), SENSOR, FrameParameters(Window(0, 50, 0, 1)))


def test_entries_say_what_why_and_how_much():
    for entry in plan(_scene("flat"), SENSOR, FrameParameters(FULL, mask=1)).left_out:
        assert all(isinstance(v, str) and v for v in entry)
        assert any(c.isdigit() for c in entry.saved)
