"""Capacitances of all conductors of a layout, with coupling, by rays: 2.5-D, as cells.extract.capacitance has them.

Every edge is sampled by rays outwards, STEP_UM apart. A ray ends at the nearest conductor of its own level, or at
REACH_UM: that distance gives the lateral coupling (aF / (distance + offset)). Of the edge's fringe field downwards the
part 2/pi * (atan(k far) - atan(k near)), k = 0.02 /um * the overlap coefficient in aF/um2, ends on what the ray passes
over between the distances near and far: the highest conductor below it there, else the substrate. The same upwards, to
the lowest conductor above. A conductor's underside is sampled by rays across it, where every length counts with the
overlap coefficient. This is the model of Magic (ExtCouple.c), whose coefficients the processes' tables are.

Metals have all of this. Poly has what its edges couple to metals above it, and diffusion is seen from above alone: the
rest of their capacitances are inside cells, and in the models of the transistors.
"""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit, types
from numba.typed import Dict

from platforms.layers import Crossing
from platforms.wires import Wires

from .bins import Bins, Ints
from .shapes import METAL_LEVEL, POLY_LEVEL, Shapes

STEP_UM, REACH_UM = 0.1, 8.0
MOST = 4096  # conductors that one ray may pass
Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Capacitances:
    """own: fF of each box to all other nets and the substrate. pairs: (m, 2) nets, the lower number first; the
    substrate is the last net's number + 1. coupling: fF of each pair."""

    own: Floats
    pairs: Ints
    coupling: Floats


def capacitances(shapes: Shapes, wires: Wires) -> Capacitances:
    """Capacitances of ``shapes`` at one corner."""
    count = len(shapes.names)
    tables = np.zeros((3, count, count))  # overlap, down, up; [upper, lower]
    crossings = {(c.upper, c.lower): c for c in wires.crossings}
    for upper in range(METAL_LEVEL, count):
        for lower in range(upper):
            c = crossings.get((shapes.names[upper], shapes.names[lower]), Crossing("", "", 0.0, 0.0, 0.0))
            tables[:, upper, lower] = c.overlap_af_um2, c.down_af_um, c.up_af_um
    sides = np.array([wires.sidewalls.get(name, (0.0, 1.0)) for name in shapes.names])
    own, keys, values = _capacitances(shapes.boxes, shapes.levels, shapes.nets, shapes.bins, shapes.dbu, tables, sides)
    pairs = np.stack(np.divmod(keys, shapes.net_count + 1), axis=1).astype(np.int32)
    return Capacitances(own / 1000, pairs, values / 1000)


@njit(cache=True)
def _capacitances(
    boxes: Ints, levels: Ints, nets: Ints, bins: Bins, dbu: float, tables: Floats, sides: Floats
) -> tuple[Floats, npt.NDArray[np.int64], Floats]:
    ground = nets.max() + 1
    own = np.zeros(len(boxes) + 1)  # the last one is the substrate's
    pairs = Dict.empty(types.int64, types.float64)
    spans, ids = np.empty((MOST, 2)), np.empty(MOST, np.int32)
    edges, low, high = np.empty(2 * MOST), np.empty(2 * MOST, np.int32), np.empty(2 * MOST, np.int32)
    step = STEP_UM / dbu

    def net(n: int) -> int:
        return nets[n] if n >= 0 else ground

    for n in range(len(boxes)):
        level = levels[n]
        if level < POLY_LEVEL:
            continue
        for way in range(5):  # left, bottom, right, top: outwards; across
            wide = boxes[n, 2] - boxes[n, 0] >= boxes[n, 3] - boxes[n, 1]
            across = way == 4
            if across and level == POLY_LEVEL:
                continue
            axis = (1 if wide else 0) if across else way % 2  # of the ray
            sign = 1 if across or way > 1 else -1
            begin = boxes[n, axis] if across else boxes[n, way]
            start, end = boxes[n, 1 - axis], boxes[n, 3 - axis]
            rays = int(math.ceil((end - start) / step))
            length = (end - start) * dbu / rays
            for ray in range(rays):
                place = start + (end - start) * (ray + 0.5) / rays
                reach = (boxes[n, axis + 2] - begin) * dbu if across else REACH_UM
                count, wall, far = _pass(
                    boxes, levels, bins, dbu, n, axis, sign, begin, place, reach, not across, spans, ids
                )
                if wall >= 0 and far <= 0:
                    continue  # inside the conductor
                if wall >= 0 and nets[wall] != nets[n] and level > POLY_LEVEL:
                    value = length * sides[level, 0] / 2 / (far + sides[level, 1])
                    _add(own, pairs, n, wall, nets[n], nets[wall], ground, value)
                pieces = _pieces(spans, ids, levels, count, level, far, edges, low, high)
                for towards in range(1 if across else 2):  # below, above
                    if towards == 0 and level == POLY_LEVEL:
                        continue
                    k = 0
                    while k < pieces:
                        other = (high if towards else low)[k]
                        last = k
                        while last + 1 < pieces and (high if towards else low)[last + 1] == other:
                            last += 1
                        near, limit = edges[k], edges[last + 1]
                        k = last + 1
                        if other < 0 and towards:
                            continue
                        lower = levels[other] if other >= 0 else 0
                        overlap = tables[0, lower, level] if towards else tables[0, level, lower]
                        if across:
                            value = length * (limit - near) * overlap
                        else:
                            fringe = tables[2, lower, level] if towards else tables[1, level, lower]
                            rate = 0.02 * overlap
                            whole = limit >= REACH_UM and wall < 0
                            share = 1.0 if whole else 2 / math.pi * math.atan(rate * limit)
                            value = length * fringe * (share - 2 / math.pi * math.atan(rate * near))
                        if net(other) != nets[n]:
                            _add(own, pairs, n, other, nets[n], net(other), ground, value)
    keys, values = np.empty(len(pairs), np.int64), np.empty(len(pairs))
    for k, (key, value) in enumerate(pairs.items()):
        keys[k], values[k] = key, value
    return own[:-1], keys, values


@njit(cache=True)
def _add(
    own: Floats, pairs: "Dict[int, float]", n: int, other: int, net: int, to: int, ground: int, value: float
) -> None:
    own[n] += value
    own[other] += value
    key = np.int64(min(net, to)) * (ground + 1) + max(net, to)
    pairs[key] = pairs.get(key, 0.0) + value


@njit(cache=True)
def _pass(
    boxes: Ints,
    levels: Ints,
    bins: Bins,
    dbu: float,
    me: int,
    axis: int,
    sign: int,
    begin: int,
    place: float,
    reach: float,
    stops: bool,
    spans: Floats,
    ids: Ints,
) -> tuple[int, int, float]:
    """What a ray passes: writes distances (near, far), um, into ``spans`` and boxes into ``ids``.

    Returns their number, the box of the ray's own level that it ends at, or -1, and the distance where it ends.
    """
    count, wall, far = 0, -1, reach
    low, other = (bins.left, bins.bottom) if axis == 0 else (bins.bottom, bins.left)
    size = bins.columns if axis == 0 else bins.rows
    row = int((place - other) // bins.side)
    cell = min(max((begin - low) // bins.side, 0), size - 1)
    if sign < 0 and cell > 0 and (begin - low) % bins.side == 0:
        cell -= 1
    first = cell
    while 0 <= cell < size:
        ahead = ((low + cell * bins.side) - begin) if sign > 0 else (begin - (low + (cell + 1) * bins.side))
        if ahead * dbu > far:
            break
        index = cell * bins.rows + row if axis == 0 else row * bins.rows + cell
        for n in bins.ids[bins.first[index] : bins.first[index + 1]]:
            if n == me or not boxes[n, 1 - axis] <= place < boxes[n, 3 - axis]:
                continue
            a, b = boxes[n, axis], boxes[n, axis + 2]
            # a box that reaches into several bins counts in the first that the ray comes through
            enters = (a - low) // bins.side if sign > 0 else (b - low) // bins.side
            if cell != (max(enters, first) if sign > 0 else min(enters, first)):
                continue
            near, end = ((a - begin) * dbu, (b - begin) * dbu) if sign > 0 else ((begin - b) * dbu, (begin - a) * dbu)
            if end <= 0 or near >= far:
                continue
            if levels[n] == levels[me]:
                if stops:
                    wall, far = n, max(near, 0.0)
                continue
            spans[count, 0], spans[count, 1], ids[count] = max(near, 0.0), min(end, far), n
            count += 1
        cell += sign
    return count, wall, far


@njit(cache=True)
def _pieces(
    spans: Floats, ids: Ints, levels: Ints, count: int, level: int, far: float, edges: Floats, low: Ints, high: Ints
) -> int:
    """Cut a ray where anything begins or ends: the pieces' ``edges``, and the nearest box below and above each."""
    edges[0], edges[1] = 0.0, far
    total = 2
    for n in range(count):
        for k in range(2):
            if 0.0 < spans[n, k] < far:
                edges[total] = spans[n, k]
                total += 1
    edges[:total].sort()
    kept = 1
    for k in range(1, total):
        if edges[k] > edges[kept - 1]:
            edges[kept] = edges[k]
            kept += 1
    low[: kept - 1] = -1
    high[: kept - 1] = -1
    for n in range(count):
        k = np.searchsorted(edges[:kept], spans[n, 0])
        own = levels[ids[n]]
        while k < kept - 1 and edges[k] < spans[n, 1]:
            if own < level and (low[k] < 0 or own > levels[low[k]]):
                low[k] = ids[n]
            if own > level and (high[k] < 0 or own < levels[high[k]]):
                high[k] = ids[n]
            k += 1
    return kept - 1
