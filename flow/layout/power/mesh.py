"""IR drop of one supply over its rails and straps: a mesh of resistors, its currents drawn at the cells."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.sparse.linalg import spsolve

from talbot.platforms.layout import LayoutPlatform


@dataclass(frozen=True)
class Metal:
    """Ohm per um of a rail and of a strap; ohm of the via stack between them."""

    rail: float
    strap: float
    stack: float


class Tap(NamedTuple):
    """A cell's current. rail: index."""

    rail: int
    x_um: float
    ampere: float


def metal(tech: LayoutPlatform) -> Metal:
    """Resistances of a process: rails on that of the cells, straps on its highest, stacks as many vias as fit."""
    low, high = tech.metals[tech.rail], tech.metals[-1]
    stack = 0.0
    for via in tech.vias[tech.rail :]:
        across, along = (
            int((side - 2 * via.enclosure_um + via.space_um) / (via.size_um + via.space_um) + 1e-9)
            for side in (tech.strap_um, tech.rail_overlap_um)
        )
        stack += via.ohm / (across * along)
    return Metal(low.sheet_ohm / tech.rail_um, high.sheet_ohm / tech.strap_um, stack)


def drops(
    rails: Sequence[float], straps: Sequence[float], height: float, taps: Sequence[Tap], metal: Metal
) -> tuple[npt.NDArray[np.float64], float]:
    """Voltage between each tap and the pads (V), array (taps,), and the share of current that the solution loses.

    rails: y of each, um. straps: x of each, um, at least one; their ends at 0 and ``height`` are the pads.
    """
    crossing = np.arange(len(rails) * len(straps)).reshape(len(straps), len(rails))  # nodes of the straps
    edges: list[tuple[int, int, float]] = []
    pads: list[tuple[int, float]] = []
    where = np.zeros(len(taps), int)  # nodes of the taps
    for own in crossing.tolist():  # up a strap; half a um of it at least to a pad
        for low, high, a, b in zip(rails, rails[1:], own, own[1:]):
            edges.append((a, b, metal.strap * (high - low)))
        pads += [(own[0], metal.strap * max(0.5, rails[0])), (own[-1], metal.strap * max(0.5, height - rails[-1]))]
    nodes = crossing.size
    for r, y in enumerate(rails):  # along a rail: its taps, and where straps cross it
        own = [(tap.x_um, "tap", k) for k, tap in enumerate(taps) if tap.rail == r]
        found = sorted(own + [(x, "strap", k) for k, x in enumerate(straps)])
        ohm = metal.rail * (2 if y in (0, height) else 1)  # half a rail at the edge of the block
        before = None
        for x, kind, k in found:
            if kind == "strap":
                edges.append((nodes, int(crossing[k][r]), metal.stack))
            else:
                where[k] = nodes
            if before is not None:
                edges.append((nodes - 1, nodes, ohm * max(x - before, 1e-3)))
            before, nodes = x, nodes + 1
    drawn = np.zeros(nodes)
    drawn[where] = [tap.ampere for tap in taps]
    scale = max(float(np.abs(drawn).max(initial=0.0)), np.finfo(float).tiny)
    volts = np.asarray(spsolve(_laplacian(nodes, edges, pads), drawn / scale)) * scale
    supplied = sum(volts[node] / ohm for node, ohm in pads)
    lost = abs(supplied - drawn.sum()) / max(abs(drawn.sum()), np.finfo(float).tiny)
    return volts[where], float(lost)


def _laplacian(
    nodes: int, edges: Sequence[tuple[int, int, float]], pads: Sequence[tuple[int, float]]
) -> sparse.csc_matrix:
    """Conductances between ``nodes``. edges: (node, node, ohm). pads: (node, ohm to the pad)."""
    a, b, ohm = (np.array(column) for column in zip(*edges))
    g, shape = 1.0 / ohm.astype(float), (nodes, nodes)
    values = np.concatenate((g, g, -g, -g))
    places = np.concatenate((a, b, a, b)).astype(int), np.concatenate((a, b, b, a)).astype(int)
    ends, to_pad = zip(*pads)
    matrix = sparse.coo_matrix((values, places), shape=shape)
    return sparse.csc_matrix(matrix + sparse.coo_matrix(([1 / ohm for ohm in to_pad], (ends, ends)), shape=shape))
