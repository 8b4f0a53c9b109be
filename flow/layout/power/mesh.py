"""Voltage drop of one supply over its rails and straps: a mesh of resistors, its currents drawn where the cells are."""

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import spsolve


@dataclass(frozen=True)
class Metal:
    """Ohm per um of a rail and of a strap; Ohm of the stack of cuts between them."""

    rail: float
    strap: float
    stack: float


def metal(known):
    """Metal of an CoriolisPlatform: rails on its lowest wire, straps on its highest, stacks as straps.py draws them."""
    low, high = known.metals[0], known.metals[-1]
    stack = 0.0
    for cut in known.vias:
        across, along = (
            int((side - 2 * cut.enclosure_um + cut.space_um) / (cut.size_um + cut.space_um) + 1e-9)
            for side in (known.strap_um, known.rail_overlap_um)
        )
        stack += cut.ohm / (across * along)
    return Metal(low.sheet_ohm / known.rail_um, high.sheet_ohm / known.strap_um, stack)


def drops(rails, straps, height, taps, metal, breaks=(), gaps=()):
    """Volts by which each tap lies from the pads: array (taps,), and the largest share of current lost in the solution.

    rails: y of each, um. straps: x of each; their ends at 0 and ``height`` are the pads. taps: (rail's index, x, A)
    each. A tap on a rail that no strap reaches would have no voltage: there must be a strap. breaks: boxes (left,
    bottom, right, top) in which there are no rails. gaps: (x, bottom, top) in which a strap is cut.
    """
    rails, straps = np.asarray(rails, float), np.asarray(straps, float)
    crossing = np.arange(len(rails) * len(straps)).reshape(len(straps), len(rails))  # nodes of the straps
    nodes, edges, currents, where = crossing.size, [], [], []
    for k in range(len(straps)):  # up a strap; half a um of it, at least, to a pad at its end
        for r, (a, b) in enumerate(zip(crossing[k], crossing[k][1:])):
            if not any(x == straps[k] and rails[r] < top and bottom < rails[r + 1] for x, bottom, top in gaps):
                edges.append((a, b, metal.strap * float(rails[r + 1] - rails[r])))
    pads = [
        (crossing[k][end], metal.strap * max(0.5, gap))
        for k in range(len(straps))
        for end, gap in ((0, rails[0]), (-1, height - rails[-1]))
    ]
    for r in range(len(rails)):  # along a rail: its taps, and where straps meet it
        own = sorted(
            [(x, "tap", k) for k, (rail, x, _) in enumerate(taps) if rail == r]
            + [(x, "strap", k) for k, x in enumerate(straps)]
        )
        before, edge = None, 2 if rails[r] in (0, height) else 1  # half a rail at the edge of the block
        for x, kind, k in own:
            if kind == "strap":
                edges.append((nodes, int(crossing[k][r]), metal.stack))
            else:
                where.append((k, nodes))
                currents.append((nodes, taps[k][2]))
            if before is not None and not any(
                bottom <= rails[r] <= top and before <= left and right <= x for left, bottom, right, top in breaks
            ):
                edges.append((nodes - 1, nodes, edge * metal.rail * max(x - before, 1e-3)))
            before, nodes = x, nodes + 1
    matrix = _laplacian(nodes, edges, pads)
    drawn = np.zeros(nodes)
    for node, current in currents:
        drawn[node] += current
    scale = max(float(np.abs(drawn).max(initial=0.0)), np.finfo(float).tiny)
    volts = spsolve(matrix.tocsc(), drawn / scale) * scale
    given = sum(volts[node] / ohm for node, ohm in pads)
    lost = abs(given - drawn.sum()) / max(abs(drawn.sum()), np.finfo(float).tiny)
    found = np.zeros(len(taps))
    for k, node in where:
        found[k] = volts[node]
    return found, float(lost)


def _laplacian(nodes, edges, pads):
    a, b, ohm = (np.array(column) for column in zip(*edges))
    g = 1.0 / ohm.astype(float)
    matrix = sparse.coo_matrix(
        (
            np.concatenate((g, g, -g, -g)),
            (np.concatenate((a, b, a, b)).astype(int), np.concatenate((a, b, b, a)).astype(int)),
        ),
        shape=(nodes, nodes),
    )
    ends = sparse.coo_matrix(
        ([1 / ohm for _, ohm in pads], ([p for p, _ in pads], [p for p, _ in pads])), shape=(nodes, nodes)
    )
    return matrix + ends
