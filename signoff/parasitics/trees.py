"""Every net as a tree of resistors from its driver to its pins, the capacitance at the nodes.

A box is a resistor along its longer side between the points where vias, other boxes and pins meet it; its capacitance
is shared by these points, each up to the middle between two. Of the loops that a net has (two vias beside each other,
say) the tree keeps the path of the least resistance to each node. Ends that lead to no pin and nodes between two
resistors are then merged into their neighbours, which keeps the Elmore delays [Elmore1948] of all pins.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from talbot.models.compiled import njit
from talbot.platforms.wires import Wires
from talbot.signoff.parasitics.capacitance import Floats, Numbers
from talbot.signoff.parasitics.shapes import Shapes

LEAST_OHM = 1e-3  # of every resistor, also where two boxes touch


@dataclass(frozen=True)
class Trees:
    """Nodes of all nets. parents: of each node, or -1 of a root and of what is merged. ohm: of the resistor to the
    parent; distance: of the resistors to the root, together. femtofarad: of each node, 0 of what is merged. kept: nodes
    that remain. pins: node of each pin."""

    parents: Numbers
    ohm: Floats
    distance: Floats
    femtofarad: Floats
    kept: npt.NDArray[np.bool_]
    pins: Numbers


def trees(
    shapes: Shapes,
    femtofarad: Floats,
    wires: Wires,
    vias: Sequence[str],
    pins: Sequence[tuple[int, int, int]],
    roots: Sequence[int],
) -> Trees:
    """The trees of the nets of ``pins``.

    femtofarad: of each box. vias: LEF names of the contact and the vias, from the lowest. pins: (box, x, y) of each
    pin. roots: the pins that the trees begin at, one a net.
    """
    wanted = np.zeros(shapes.net_count, np.bool_)
    at = np.array(pins, np.int64).reshape(-1, 3)
    wanted[shapes.nets[at[:, 0]]] = True
    links = shapes.links[wanted[shapes.nets[shapes.links[:, 0]]]].astype(np.int64)
    boxes = np.concatenate((links[:, 0], links[:, 1], at[:, 0]))
    x, y = (np.concatenate((links[:, k], links[:, k], at[:, k - 1])) for k in (2, 3))
    left, bottom, right, top = shapes.boxes[boxes].T.astype(np.int64)
    wide = right - left >= top - bottom
    length, width = np.where(wide, (right - left, top - bottom), (top - bottom, right - left))
    along = np.clip(np.where(wide, x - left, y - bottom), 0, length)
    order = np.lexsort((along, boxes))
    first, second = order[:-1], order[1:]
    same = boxes[first] == boxes[second]
    names = shapes.names
    sheets = np.array([wires.ohms.get(name, 0.0) for name in names])
    squares = (along[second] - along[first]) / width[first]
    inside = (squares * sheets[shapes.levels[boxes[first]]])[same]
    cuts = np.zeros(len(names))
    cuts[2 : 2 + len(vias)] = [wires.ohms[via] for via in vias]
    count = len(links)
    between = np.where(links[:, 4] < 0, 0.0, cuts[links[:, 4]])
    a = np.concatenate((first[same], np.arange(count)))
    b = np.concatenate((second[same], np.arange(count, 2 * count)))
    ohm = np.maximum(np.concatenate((inside, between)), LEAST_OHM)
    graph = coo_array((ohm, (a, b)), shape=(len(boxes), len(boxes))).tocsr()
    pin_nodes = 2 * count + np.arange(len(at))
    begin = pin_nodes[np.array(roots, np.int64)]
    distance, parents, _ = dijkstra(graph, directed=False, indices=begin, return_predecessors=True, min_only=True)
    # a box's share from the middle between two points to the next such middle
    ends = np.where(same, (along[first] + along[second]) / 2, 0.0)
    low = np.concatenate(([0.0], ends))
    high = np.concatenate((np.where(same, ends, length[first]), [length[order[-1]]]))
    share = np.empty(len(boxes))
    share[order] = (high - low) / length[order]
    charge = femtofarad[boxes] * share
    parents = np.where(parents < 0, -1, parents).astype(np.int64)
    resistors = np.where(parents < 0, 0.0, distance - distance[np.maximum(parents, 0)])
    is_pin = np.zeros(len(boxes), np.bool_)
    is_pin[pin_nodes] = True
    nodes = np.flatnonzero(np.isfinite(distance))
    kept = _merge(nodes[np.argsort(distance[nodes], kind="stable")], parents, resistors, charge, is_pin)
    return Trees(parents, resistors, distance, charge, kept, pin_nodes)


@njit(cache=True)
def _merge(
    order: Numbers, parents: Numbers, ohm: Floats, charge: Floats, pins: npt.NDArray[np.bool_]
) -> npt.NDArray[np.bool_]:
    """Merge nodes, parents before children in ``order``; True for those that remain."""
    kept = np.zeros(len(parents), np.bool_)
    children = np.zeros(len(parents), np.int64)
    for node in order:
        kept[node] = True
        if parents[node] >= 0:
            children[parents[node]] += 1
    for node in order[::-1]:
        if not pins[node] and not children[node]:
            charge[parents[node]] += charge[node]
            children[parents[node]] -= 1
            kept[node], charge[node], parents[node] = False, 0.0, -1
    for node in order:
        middle = parents[node]
        if middle < 0 or pins[middle] or children[middle] != 1:
            continue
        before, after = ohm[middle], ohm[node]
        charge[node] += charge[middle] * before / (before + after)
        charge[parents[middle]] += charge[middle] * after / (before + after)
        parents[node], ohm[node] = parents[middle], before + after
        kept[middle], charge[middle], parents[middle] = False, 0.0, -1
    return kept
