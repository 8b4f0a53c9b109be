"""Sinks shared among the leaves of a clock's tree: none bears more than its share or hangs farther than it must."""

from collections import Counter
from itertools import product

from flow.layout.coriolis.leaves import shared

LEAVES = [(0, 0), (100, 0), (0, 100), (100, 100)]


def test_a_crowd_is_shared():
    crowd = [(x, y) for x in range(10) for y in range(8)]
    assert sorted(Counter(shared(crowd, LEAVES)).values()) == [5, 25, 25, 25]


def test_even_sinks_hang_from_the_nearest_leaf():
    sinks = [(x + dx, y + dy) for x, y in LEAVES for dx, dy in product((-3, 4), (-2, 5))]
    assert shared(sinks, LEAVES) == [k for k in range(4) for _ in range(4)]
