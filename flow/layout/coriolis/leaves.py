"""Clock sinks assigned to the leaves of the tree: all have about the same load, so that skew is low."""

from collections.abc import Sequence
from math import ceil
from typing import Any

import numpy as np
from scipy.optimize import linear_sum_assignment

SHARE = 1.25  # of the mean: most sinks of a leaf; with less, sinks are on leaves farther away


def assigned(sinks: Sequence[tuple[float, float]], leaves: Sequence[tuple[float, float]]) -> list[int]:
    """Number of the leaf of every sink; sinks, leaves: points (x, y).

    The sum of the squared distances is the least with at most SHARE times the mean number of sinks on any leaf.
    """
    here, there = np.array(sinks, float).reshape(-1, 2), np.array(leaves, float).reshape(-1, 2)
    places = np.repeat(np.arange(len(leaves)), ceil(SHARE * len(sinks) / len(leaves)))
    distances = ((here[:, None, :] - there[None, places, :]) ** 2).sum(2)
    _, chosen = linear_sum_assignment(distances)
    return [int(leaf) for leaf in places[chosen]]


def balance(tree: Any) -> None:
    """Let ``tree``, a QuadTree of Coriolis, assign its sinks so and not each to the nearest leaf."""
    held, split = [], tree.rsplitNetlist

    def rsplit() -> None:
        """Assign the sinks, then split the netlist as before."""
        ends = _ends(tree)
        points = [sink.getBoundingBox().getCenter() for sink in held]
        middles = [leaf.area.getCenter() for leaf in ends]
        numbers = assigned(*([(at.getX(), at.getY()) for at in found] for found in (points, middles)))
        for sink, number in zip(held, numbers, strict=True):
            ends[number].plugs.append(sink)
        split()

    tree.attachToLeaf, tree.rsplitNetlist = held.append, rsplit


def _ends(tree: Any) -> list[Any]:
    return [tree] if tree.isLeaf() else [end for branch in tree.leafs for end in _ends(branch)]
