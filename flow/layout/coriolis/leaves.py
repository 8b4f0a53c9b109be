"""Sinks of the clock shared among the leaves of its tree: all leaves bear about alike, so edges come at one time."""

from math import ceil

import numpy as np
from scipy.optimize import linear_sum_assignment

SHARE = 1.25  # of the mean: most sinks of a leaf; with less, sinks hang from leaves farther away


def shared(sinks, leaves):
    """List of the leaf (its number) of every sink; sinks, leaves: points (x, y). The sum of the squared distances is
    the least with at most SHARE times the mean number of sinks on any leaf."""
    sinks, leaves = np.array(sinks, float).reshape(-1, 2), np.array(leaves, float).reshape(-1, 2)
    places = np.repeat(np.arange(len(leaves)), ceil(SHARE * len(sinks) / len(leaves)))
    distances = ((sinks[:, None, :] - leaves[None, places, :]) ** 2).sum(2)
    _, chosen = linear_sum_assignment(distances)
    return [int(leaf) for leaf in places[chosen]]


def balance(tree):
    """Let ``tree``, a QuadTree of Coriolis, hang its sinks so and not each from the leaf that is next to it."""
    held, split = [], tree.rsplitNetlist

    def rsplit():
        ends = _ends(tree)
        points = [sink.getBoundingBox().getCenter() for sink in held]
        middles = [leaf.area.getCenter() for leaf in ends]
        numbers = shared(*([(at.getX(), at.getY()) for at in found] for found in (points, middles)))
        for sink, number in zip(held, numbers, strict=True):
            ends[number].plugs.append(sink)
        split()

    tree.attachToLeaf, tree.rsplitNetlist = held.append, rsplit


def _ends(tree):
    return [tree] if tree.isLeaf() else [end for branch in tree.leafs for end in _ends(branch)]
