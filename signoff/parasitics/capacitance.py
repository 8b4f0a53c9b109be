"""Capacitances of all conductors of a layout, with coupling, by rays: 2.5-D, as cells.extract.capacitance has them.

Every edge is sampled by rays outwards, at most STEP_UM apart. A ray ends at the nearest conductor of its own level, or
at REACH_UM: that distance gives the lateral coupling (aF / (distance + offset)). Of the edge's fringe field downwards
the part 2/pi * (atan(k far) - atan(k near)), k = Wires.rate * the overlap coefficient in aF/um2, ends on what the ray
passes over between the distances near and far: the highest conductor below it there, else the substrate. The same
upwards, to the lowest conductor above. A conductor's underside is sampled by rays across it, where every length counts
with the overlap coefficient. So far this is the model of Magic (ExtCouple.c), in which these add. But a plane that
takes a part s of the field also takes it from the neighbour, whose coupling here is (1 - s)^screening of that, and the
fields downwards and upwards, d and u, share the edge: together (d^norm + u^norm)^(1/norm).

Metals have all of this. Poly has what its edges couple to metals above it, and diffusion is seen from above alone: the
rest of their capacitances are inside cells, and in the models of the transistors.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import types
from numba.typed import Dict

from talbot.models.compiled import njit
from talbot.platforms.layers import Crossing
from talbot.platforms.wires import Wires
from talbot.signoff.parasitics.bins import Bins, Ints
from talbot.signoff.parasitics.shapes import METAL_LEVEL, POLY_LEVEL, Shapes

STEP_UM, REACH_UM = 0.2, 8.0
MOST = 4096  # conductors that one ray may pass
ACROSS = 4  # the fifth way of rays: left, bottom, right, top, across the box
Floats = npt.NDArray[np.float64]
Numbers = npt.NDArray[np.int64]
Flags = npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Capacitances:
    """Capacitances of a layout.

    own: fF of each box to all other nets and the substrate. pairs: (m, 2) nets that couple, the lower number first;
    the substrate is the last net's number + 1. coupling: fF of each pair.
    """

    own: Floats
    pairs: Ints
    coupling: Floats


def capacitances(shapes: Shapes, corners: Sequence[Wires], paired: Flags | None = None) -> list[Capacitances]:
    """Capacitances of ``shapes`` at each of ``corners``. paired: whether a net is to be in the pairs; default all."""
    count = len(shapes.names)
    tables = np.zeros((3, count, count, len(corners)))  # overlap, down, up; upper, lower
    sides = np.ones((2, count, len(corners)))
    model = np.array([(wires.rate, wires.screening, wires.norm) for wires in corners])
    for n, wires in enumerate(corners):
        crossings = {(c.upper, c.lower): c for c in wires.crossings}
        for upper in range(METAL_LEVEL, count):
            sides[:, upper, n] = wires.sidewalls.get(shapes.names[upper], (0.0, 1.0))
            for lower in range(upper):
                c = crossings.get((shapes.names[upper], shapes.names[lower]), Crossing("", "", 0.0, 0.0, 0.0))
                tables[:, upper, lower, n] = c.overlap_af_um2, c.down_af_um, c.up_af_um
    wanted = np.append(np.ones(shapes.net_count, np.bool_) if paired is None else paired, False)
    touching = shapes.links[shapes.links[:, 4] < 0]
    ends = np.concatenate((touching[:, [0, 1]], touching[:, [1, 0]]))
    ends = ends[np.argsort(ends[:, 0], kind="stable")]
    first = np.searchsorted(ends[:, 0], np.arange(len(shapes.boxes) + 1))
    own, keys, values = _capacitances(
        shapes.boxes,
        shapes.levels,
        shapes.nets,
        shapes.bins,
        first,
        ends[:, 1].copy(),
        shapes.dbu,
        tables,
        sides,
        model,
        wanted,
    )
    pairs = np.stack(np.divmod(keys, shapes.net_count + 1), axis=1).astype(np.int32)
    return [Capacitances(own[:, n] / 1000, pairs, values[:, n] / 1000) for n in range(len(corners))]


@njit(cache=True)
def _capacitances(
    boxes: Ints,
    levels: Ints,
    nets: Ints,
    bins: Bins,
    first: Numbers,
    touching: Ints,
    dbu: float,
    tables: Floats,
    sides: Floats,
    model: Floats,
    paired: Flags,
) -> tuple[Floats, Numbers, Floats]:
    corners = tables.shape[3]
    own = np.zeros((len(boxes) + 1, corners))  # the last one is the substrate's
    rows = Dict.empty(types.int64, types.int64)
    values = np.zeros((1024, corners))
    spans, ids, exposed = np.empty((MOST, 2)), np.empty(MOST, np.int32), np.empty((MOST, 2), np.int32)
    edges, low, high = np.empty(2 * MOST), np.empty(2 * MOST, np.int32), np.empty(2 * MOST, np.int32)
    seen, amount = np.empty(4 * MOST, np.int32), np.empty((4 * MOST, corners))  # of the runs of a ray
    fields, shields, value = np.empty((2, corners)), np.empty((2, corners)), np.empty(corners)
    for n in range(len(boxes)):
        level = levels[n]
        if level < POLY_LEVEL:
            continue
        for way in range(4 if level == POLY_LEVEL else 5):
            across = way == ACROSS
            axis = way % 2  # of the rays
            if across and boxes[n, 2] - boxes[n, 0] >= boxes[n, 3] - boxes[n, 1]:
                axis = 1
            sign = 1 if way > 1 else -1
            begin = boxes[n, axis] if across else boxes[n, way]
            exposed[0, 0], exposed[0, 1] = boxes[n, 1 - axis], boxes[n, 3 - axis]
            parts = 1 if across else _exposed(boxes, touching[first[n] : first[n + 1]], axis, begin, exposed)
            for part in range(parts):
                start, end = exposed[part]
                rays = int(math.ceil((end - start) * dbu / STEP_UM - 1e-9))
                length = (end - start) * dbu / rays
                for ray in range(rays):
                    place = start + (end - start) * (ray + 0.5) / rays
                    reach = (boxes[n, axis + 2] - begin) * dbu if across else REACH_UM
                    count, wall, far = _pass(
                        boxes, levels, bins, dbu, level, axis, sign, begin, place, reach, not across, spans, ids
                    )
                    pieces = _pieces(spans, ids, levels, count, level, far, edges, low, high)
                    runs = 0
                    fields[:], shields[:] = 0.0, 0.0
                    for up in range(1 if level == POLY_LEVEL else 0, 1 if across else 2):
                        beside = high if up else low
                        last = 0
                        while last < pieces:
                            other, near = beside[last], edges[last]
                            while last < pieces and beside[last] == other:
                                last += 1
                            if other < 0 and up:
                                continue
                            top, bottom = level, levels[other] if other >= 0 else 0
                            if up:
                                top, bottom = bottom, top
                            for c in range(corners):
                                overlap = tables[0, top, bottom, c]
                                if across:
                                    amount[runs, c] = length * (edges[last] - near) * overlap
                                    continue
                                rate = model[c, 0] * overlap
                                whole = wall < 0 and last == pieces  # what is beyond REACH_UM, too
                                angle = math.pi / 2 if whole else math.atan(rate * edges[last])
                                share = (angle - math.atan(rate * near)) * 2 / math.pi
                                amount[runs, c] = length * tables[1 + up, top, bottom, c] * share
                                fields[up, c] += amount[runs, c]
                                if bottom >= POLY_LEVEL:
                                    shields[up, c] += share
                            seen[runs] = other
                            runs += 1
                    if not across:
                        for c in range(corners):
                            both = fields[0, c] + fields[1, c]
                            norm = model[c, 2]
                            value[c] = (fields[0, c] ** norm + fields[1, c] ** norm) ** (1 / norm) / max(both, 1e-30)
                        for run in range(runs):
                            for c in range(corners):
                                amount[run, c] *= value[c]
                    for run in range(runs):
                        if seen[run] < 0 or nets[seen[run]] != nets[n]:
                            values = _add(own, rows, values, n, seen[run], nets, paired, amount[run])
                    if wall >= 0 and nets[wall] != nets[n] and level > POLY_LEVEL:
                        for c in range(corners):
                            coupled = length * sides[0, level, c] / 2 / (far + sides[1, level, c])
                            open_part = max((1 - shields[0, c]) * (1 - shields[1, c]), 0.0)
                            value[c] = coupled * open_part ** model[c, 1]
                        values = _add(own, rows, values, n, wall, nets, paired, value)
    keys, found = np.empty(len(rows), np.int64), np.empty((len(rows), corners))
    for k, (key, row) in enumerate(rows.items()):
        keys[k], found[k] = key, values[row]
    return own[:-1], keys, found


@njit(cache=True)
def _add(
    own: Floats, rows: "Dict[int, int]", values: Floats, n: int, other: int, nets: Ints, paired: Flags, value: Floats
) -> Floats:
    """Add ``value`` between the boxes ``n`` and ``other``, or the substrate for -1; ``values``, larger where full."""
    for c in range(len(value)):
        own[n, c] += value[c]
        own[other, c] += value[c]
    ground = len(paired) - 1
    to = nets[other] if other >= 0 else ground
    if not (paired[nets[n]] or paired[to]):
        return values
    key = np.int64(min(nets[n], to)) * (ground + 1) + max(nets[n], to)
    if key not in rows:
        rows[key] = len(rows)
        if len(rows) > len(values):
            values = np.concatenate((values, np.zeros_like(values)))
    row = rows[key]
    for c in range(len(value)):
        values[row, c] += value[c]
    return values


@njit(cache=True)
def _exposed(boxes: Ints, touching: Ints, axis: int, begin: int, exposed: Ints) -> int:
    """Parts of the side at ``begin`` that no box of ``touching`` covers: exposed[0] is the side; their number."""
    count = 1
    for n in touching:
        if boxes[n, axis] != begin and boxes[n, axis + 2] != begin:
            continue
        low, high = boxes[n, 1 - axis], boxes[n, 3 - axis]
        kept = count
        for k in range(count):
            start, end = exposed[k]
            if high <= start or end <= low:
                continue
            exposed[k, 1] = max(min(low, end), start)
            if high < end:
                exposed[kept, 0], exposed[kept, 1] = max(high, start), end
                kept += 1
        count = 0
        for k in range(kept):
            if exposed[k, 0] < exposed[k, 1]:
                exposed[count, 0], exposed[count, 1] = exposed[k, 0], exposed[k, 1]
                count += 1
    return count


@njit(cache=True)
def _pass(
    boxes: Ints,
    levels: Ints,
    bins: Bins,
    dbu: float,
    level: int,
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

    Returns their number, the box of ``level`` that the ray ends at, or -1, and the distance where it ends.
    """
    count, wall, far = 0, -1, reach
    low, other = (bins.left, bins.bottom) if axis == 0 else (bins.bottom, bins.left)
    size = bins.columns if axis == 0 else bins.rows
    row = int((place - other) // bins.side)
    cell = min(max((begin - low) // bins.side, 0), size - 1)
    begun = cell
    while 0 <= cell < size:
        ahead = (low + cell * bins.side - begin) if sign > 0 else (begin - low - (cell + 1) * bins.side)
        if ahead * dbu > far:
            break
        index = cell * bins.rows + row if axis == 0 else row * bins.rows + cell
        for k in range(bins.first[index], bins.first[index + 1]):
            n = bins.ids[k]
            if levels[n] == level and not stops or not boxes[n, 1 - axis] <= place < boxes[n, 3 - axis]:
                continue
            a, b = boxes[n, axis], boxes[n, axis + 2]
            near, end = ((a - begin) * dbu, (b - begin) * dbu) if sign > 0 else ((begin - b) * dbu, (begin - a) * dbu)
            if end <= 0 or near >= far:
                continue
            # a box that reaches into several bins counts in the first that the ray comes through
            enters = (a - low) // bins.side if sign > 0 else (b - low) // bins.side
            if cell != (max(enters, begun) if sign > 0 else min(enters, begun)):
                continue
            if levels[n] == level:
                wall, far = n, max(near, 0.0)  # boxes of slanted metal may reach behind the side
                continue
            spans[count, 0], spans[count, 1], ids[count] = max(near, 0.0), end, n
            count += 1
        cell += sign
    return count, wall, far


@njit(cache=True)
def _pieces(
    spans: Floats, ids: Ints, levels: Ints, count: int, level: int, far: float, edges: Floats, low: Ints, high: Ints
) -> int:
    """Cut a ray where anything begins or ends: writes the pieces' edges, and the nearest box below and above each."""
    edges[0], edges[1] = 0.0, far
    kept = 2
    for n in range(count):
        for end in spans[n]:
            if not 0.0 < end < far:
                continue
            k = kept
            while edges[k - 1] > end:
                k -= 1
            if edges[k - 1] < end:
                edges[k + 1 : kept + 1] = edges[k:kept]
                edges[k] = end
                kept += 1
    low[: kept - 1] = -1
    high[: kept - 1] = -1
    for n in range(count):
        own, k = levels[ids[n]], 0
        while edges[k] < spans[n, 0] and k < kept - 1:
            k += 1
        while k < kept - 1 and edges[k] < spans[n, 1]:
            if own < level and (low[k] < 0 or own > levels[low[k]]):
                low[k] = ids[n]
            if own > level and (high[k] < 0 or own < levels[high[k]]):
                high[k] = ids[n]
            k += 1
    return kept - 1
