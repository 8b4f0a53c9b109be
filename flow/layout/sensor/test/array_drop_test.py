"""The array's supply: a row by hand, and what a second side and lines across the rows change."""

from dataclasses import replace

import numpy as np
import pytest

from talbot.flow.layout.sensor.array_drop import LEAST_OHM, Feed, Mesh, drops
from talbot.models.parameters import ArrayParameters

ARRAY = ArrayParameters(8, 12)
SINK, PLATE = 5e-6, 0.2
# Rows that hardly any line joins, a bus and a track of no resistance
ROWS = Mesh(PLATE, 1e9, 1e-6, 0.0, 1e-6, [Feed(60.0, 1e-3)], [60.0], 0.0)


def test_a_row_by_hand():
    """Behind every plate flow the sinks of all pixels west of it; the last plate is half of one."""
    (found,) = drops(ROWS, ARRAY, [3], SINK)
    amperes = 2 * SINK * np.arange(1, ARRAY.cols + 1)  # through the plate east of pixel k
    east = 2 * SINK * ARRAY.cols * (2.5 * PLATE + 1e-3 + 2 * LEAST_OHM)  # two dummies, half a plate, feed, track, pad
    wanted = east + PLATE * np.array([amperes[k:-1].sum() for k in range(ARRAY.cols)])
    assert found == pytest.approx(wanted, rel=2e-3)


def test_two_sides_are_a_quarter_of_one_within_the_row():
    one, two = (drops(ROWS, ARRAY, [3], SINK, both)[0] for both in (False, True))
    assert two == pytest.approx(two[::-1], rel=1e-6)
    assert np.ptp(two) < 0.3 * np.ptp(one)


def test_lines_share_the_current_with_other_rows():
    alone, shared = (drops(replace(ROWS, line=line), ARRAY, [0, 3], SINK) for line in (1e9, 1.0))
    assert shared.max() < 0.7 * alone.max()
    assert shared[0].max() > shared[1].max()  # at the edge rows on one side alone help
