"""IR drop of the drawn array's supply while one row is read: a mesh of its plates and lines, and the way to the pads.

In every pixel the supply's plate goes from west to east and its line from south to north, joined by a via. In the east
all plates end at a bus. From the bus's pins the die's lines on the top metal lead to a track of the ring, whose pads
are the supply.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.sparse.linalg import factorized

from talbot.models.parameters import ArrayParameters
from talbot.pixels.blocks import AnalogSizes
from talbot.pixels.layout.array import DUMMIES, SUPPLY_BUS
from talbot.pixels.layout.pixel import COLUMNS, LINE, PLATE, PLATES, UPPER
from talbot.platforms.die import TopMetal
from talbot.platforms.layout import LayoutPlatform

NET = "vdda"
LEAST_OHM = 1e-3  # of a pad, and of the track between two places
Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Feed:
    """A line from a pin of the array to the ring's track. y_um: of both. ohm: of the line."""

    y_um: float
    ohm: float


@dataclass(frozen=True)
class Mesh:
    """Ohm of a pixel's plate, of its line, of the bus beside it, of the vias between plate and bus, of the track by um.

    pads_um: y of the track's pads. south_um: y of the first row of dummies.
    """

    plate: float
    line: float
    bus: float
    join: float
    track_um: float
    feeds: Sequence[Feed]
    pads_um: Sequence[float]
    south_um: float


def mesh(plan: Mapping[str, Any], array: ArrayParameters, tech: LayoutPlatform, top: TopMetal) -> Mesh:
    """The mesh of the die's plan, its supplies in the east."""
    pitch = array.pitch * 1e6
    left, bottom, right, upper = (nm / 1000 for nm in plan["blocks"]["pixel_array"]["box"])
    track = plan["die"][0] / 1000 - (plan["frame"]["seal"] + plan["frame"]["depth"]) / 1000
    feeds = [
        Feed((box[1] + box[3]) / 2000, top.metal.sheet_ohm * (track - right) / AnalogSizes().supply_um)
        for net, layer, datatype, *box in plan["shapes"]
        if net == NET and (layer, datatype) == top.metal.gds
        if bottom < box[1] / 1000 < upper and box[0] / 1000 < right < box[2] / 1000
    ]
    pads = [
        (pad["box"][1] + pad["box"][3]) / 2000
        for pad in plan["ring"]
        if pad["side"] == "east" and pad["name"].startswith(f"pad_{NET}")
    ]
    metals = tech.metals
    wide = PLATE[1] - PLATE[0], LINE, SUPPLY_BUS[1] - SUPPLY_BUS[0]
    plate, line, bus = (
        metals[level].sheet_ohm * pitch / width for level, width in zip((PLATES, COLUMNS, UPPER), wide, strict=True)
    )
    south = bottom + (upper - bottom - (array.rows + 2 * DUMMIES) * pitch) / 2
    return Mesh(plate, line, bus, tech.vias[PLATES].ohm / 6, track_ohm(tech), feeds, pads, south)


def track_ohm(tech: LayoutPlatform) -> float:
    """Of a um of the ring's track: three metals, each as wide as the pads have it."""
    return 1 / sum(width / tech.metals[level].sheet_ohm for level, width in ((2, 13.8), (3, 12.3), (4, 13.8)))


def drops(made: Mesh, array: ArrayParameters, read: Sequence[int], sink_a: float, both: bool = False) -> Floats:
    """Drop (V) at the pixels of each row in ``read``, counted from the south, (rows, cols); two sinks a column.

    The dummies around the pixels are part of the mesh. both: as if the array were fed in the west as in the east.
    """
    rows, cols, pitch = array.rows + 2 * DUMMIES, array.cols + 2 * DUMMIES, array.pitch * 1e6
    pixels = np.arange(rows * cols).reshape(rows, cols)
    edges: list[Any] = [(pixels[:, :-1], pixels[:, 1:], made.plate), (pixels[:-1], pixels[1:], made.line)]
    nodes, pads = rows * cols, list[tuple[int, float]]()
    for end in (-1, 0)[: 1 + both]:
        bus = nodes + np.arange(rows)
        edges += [(bus[:-1], bus[1:], made.bus), (pixels[:, end], bus, made.plate / 2 + made.join)]
        nodes += rows
        places = sorted([*((feed.y_um, feed) for feed in made.feeds), *((y, None) for y in made.pads_um)], key=_y)
        for k, (y, feed) in enumerate(places):
            if k:
                edges.append((nodes + k - 1, nodes + k, max(made.track_um * (y - places[k - 1][0]), LEAST_OHM)))
            if feed:
                at = min(max(int((y - made.south_um) / pitch), 0), rows - 1)
                edges.append((int(bus[at]), nodes + k, feed.ohm))
            else:
                pads.append((nodes + k, 1 / LEAST_OHM))
        nodes += len(places)
    solve = factorized(_conductance(nodes, edges, pads))
    found = np.empty((len(read), array.cols))
    for k, row in enumerate(read):
        drawn, own = np.zeros(nodes), pixels[row + DUMMIES, DUMMIES:-DUMMIES]
        drawn[own] = 2 * sink_a
        found[k] = solve(drawn)[own]
    return found


def _y(place: tuple[float, Feed | None]) -> float:
    return place[0]


def _conductance(nodes: int, edges: Sequence[Any], pads: Sequence[tuple[int, float]]) -> sparse.csc_matrix:
    """edges: (nodes, nodes, ohm). pads: (node, siemens to the supply)."""
    a, b = (np.concatenate([np.ravel(edge[k]) for edge in edges]) for k in (0, 1))
    g = np.concatenate([np.full(np.size(edge[0]), 1 / edge[2]) for edge in edges])
    at, to_pad = zip(*pads)
    rows, columns = np.concatenate((a, b, a, b, at)), np.concatenate((a, b, b, a, at))
    values = np.concatenate((g, g, -g, -g, to_pad))
    return sparse.csc_matrix(sparse.coo_matrix((values, (rows, columns)), shape=(nodes, nodes)))
