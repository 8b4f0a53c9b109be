"""Clock sinks on the leaves of the tree: none has more than its share, or is farther away than it must be."""

from collections import Counter
from itertools import product

from talbot.flow.layout.coriolis.leaves import assigned

LEAVES = [(0, 0), (100, 0), (0, 100), (100, 100)]


def test_a_crowd_is_assigned():
    crowd = [(x, y) for x in range(10) for y in range(8)]
    assert sorted(Counter(assigned(crowd, LEAVES)).values()) == [5, 25, 25, 25]


def test_even_sinks_are_on_the_nearest_leaf():
    sinks = [(x + dx, y + dy) for x, y in LEAVES for dx, dy in product((-3, 4), (-2, 5))]
    assert assigned(sinks, LEAVES) == [k for k in range(4) for _ in range(4)]
