"""Common centroid: counts, middles, and what a gradient across the array does to the levels."""

import numpy as np
import pytest

from talbot.pixels.analog_layout.pattern import SIDE, binary, halves

BITS = [f"bit{k}" for k in range(8)]


def inl(values):
    """Peak INL in LSB where every unit has its value."""
    names = binary()
    weights = np.array([values[names == name].sum() for name in BITS])
    codes = np.arange(256)
    levels = 256 * ((codes[:, None] >> np.arange(8) & 1) @ weights) / values.sum()
    return float(np.abs(levels - np.linspace(0, levels[-1], 256)).max())


def test_every_bit_has_its_units_and_a_column_no_more_than_five_lines():
    names = binary()
    assert [int((names == name).sum()) for name in BITS] == [1 << k for k in range(8)]
    assert (names == "terminator").sum() == 1
    assert max(len(set(names[:, column])) for column in range(SIDE)) <= 5
    assert (halves() == "refp").sum() == SIDE**2 // 2


def test_middles_are_the_arrays_but_for_the_two_that_are_alone():
    found = {}
    for names in binary(), halves():
        for name in np.unique(names):
            found[str(name)] = tuple(float(k.mean() - (SIDE - 1) / 2) for k in np.nonzero(names == name))
    alone = found.pop("bit0"), found.pop("terminator")
    assert all(middle == (0, 0) for middle in found.values())
    assert np.hypot(*alone[0]) == np.hypot(*alone[1]) == pytest.approx(0.5**0.5)


@pytest.mark.parametrize("slope", [(0.01, 0), (0, 0.01), (0.007, -0.007)])
def test_a_gradient_cancels(slope):
    row, column = np.indices((SIDE, SIDE)) - (SIDE - 1) / 2
    values = 1 + slope[0] * row / SIDE + slope[1] * column / SIDE
    assert inl(values) < 0.002
    rows = np.repeat(BITS, 1 << np.arange(8))  # the same units row by row, as they come
    plain = np.append(rows, "terminator").reshape(SIDE, SIDE)
    weights = np.array([values[plain == name].sum() for name in BITS])
    assert abs(256 * weights[-1] / values.sum() - 128) > 0.1 or slope[0] == 0


def test_a_bow_moves_the_levels_by_less_than_a_tenth():
    row, column = np.indices((SIDE, SIDE)) - (SIDE - 1) / 2
    assert inl(1 + 0.01 * (row**2 + column**2) / (2 * (SIDE / 2) ** 2)) < 0.1
