"""Cells placed for short wires, by Coloquinte, with room where many wires are."""

from collections.abc import Collection, Sequence

import coloquinte
import numpy as np
import numpy.typing as npt
from coloquinte import CellOrientation, CellRowPolarity, ColoquinteParameters, Rectangle, Row

from ..netlist.placed import MIRRORED
from .repair import MORE, Plan

FULL = 0.99  # of the rows, at most: cells, and what is kept free beside each
SEED, TURNS = 1, 6  # the room beside a cell follows from the wires of the turn before
GAPS = 2, 1, 0  # sites beside each cell, the first that there is room for: a diode's and one between pins
BIN = 4  # rows: side of a square in which wires are counted
Ints = npt.NDArray[np.int64]
Floats = npt.NDArray[np.float64]
Ends = list[int | tuple[float, float]]


def arranged(plan: Plan, fixed: Collection[str], effort: int, spread: float) -> None:
    """Place all cells of the library but ``fixed`` again, for short nets, those of ``fixed`` left out.

    effort: of the placer, 1..9. spread: of what is empty, the share between cells, so that wires are everywhere alike.
    """
    names = [name for name, i in plan.instances.items() if name not in fixed and i.cell in plan.widths]
    for name in names:
        plan.rows.give(plan.widths[plan.instances[name].cell], plan.places[name])
    site, height = plan.rows.site, plan.rows.height
    tall = round(height / site)  # the placer's unit is a site; a row is a whole number of them high, or nearly
    nets = list(connections(plan, fixed, names).values())
    held = sorted({end for ends in nets for end in ends if not isinstance(end, int)})
    numbers = {end: len(names) + k for k, end in enumerate(held)}
    which = [[end if isinstance(end, int) else numbers[end] for end in ends] for ends in nets]
    widths = np.array([round(plan.widths[plan.instances[name].cell] / site) for name in names])
    lows = {round((y + min(0, MIRRORED[way][1]) * height) / height) * tall: (y, way) for y, way in plan.rows.rows}
    spans = [(low, *span) for low, row in lows.items() for span in plan.rows.rows[row]]

    circuit = coloquinte.Circuit(len(names) + len(held))
    zeros = [0 for _ in held]
    circuit.cell_width, circuit.cell_height = [*widths.tolist(), *zeros], [*(tall for _ in names), *zeros]
    circuit.cell_x = [*(0 for _ in names), *(round(x / site) for x, _ in held)]
    circuit.cell_y = [*(0 for _ in names), *(round(y / height * tall) for _, y in held)]
    circuit.cell_is_fixed = [*(False for _ in names), *(True for _ in held)]
    circuit.cell_is_obstruction = [*(True for _ in names), *(False for _ in held)]
    circuit.cell_row_polarity = [CellRowPolarity.SAME for _ in (*names, *held)]
    circuit.rows = [Row(Rectangle(begin, end, low, low + tall), CellOrientation.N) for low, begin, end in spans]
    middles = [*((int(wide) // 2, tall // 2) for wide in widths), *((0, 0) for _ in held)]
    for ends in which:
        circuit.add_net(ends, *map(list, zip(*(middles[end] for end in ends), strict=True)))

    parameters = ColoquinteParameters(effort, SEED)
    room = sum(end - begin for _, begin, end in spans)
    room = widths.sum() + spread * max(0.0, FULL * room - widths.sum())
    least = widths + next(gap for gap in GAPS if not gap or widths.sum() + gap * len(widths) <= room)
    wires = np.bincount([end for ends in which for end in ends], minlength=len(middles))[: len(names)].astype(float)
    for _ in range(TURNS):
        circuit.cell_width = [*filled(least, wires, room).tolist(), *zeros]
        circuit.place_global(parameters)
        middle = (np.array(axis) + np.array(size) / 2 for axis, size in (
            (circuit.cell_x, circuit.cell_width), (circuit.cell_y, circuit.cell_height)))  # fmt: skip
        wires = crowding(np.stack(list(middle), axis=1), which, BIN * tall)[: len(names)]
    circuit.cell_width = [*least.tolist(), *zeros]
    circuit.legalize(parameters)
    circuit.place_detailed(parameters)
    for name, x, low in zip(names, circuit.cell_x, circuit.cell_y, strict=False):
        place = round(x * site, 4), *lows[low]
        plan.rows.claim(plan.widths[plan.instances[name].cell], place)
        plan.places[name] = place


def filled(widths: Ints, wires: Floats, room: float) -> Ints:
    """Widths (sites) with what is kept free beside each cell, ``room`` in all: as ``wires``, at least the cell's."""
    low, high = 0.0, room / max(wires.sum(), 1e-9) * len(widths)
    for _ in range(60):
        share = (low + high) / 2
        low, high = (share, high) if np.maximum(widths, share * wires).sum() < room else (low, share)
    ends = np.round(np.cumsum(np.maximum(widths, low * wires))).astype(np.int64)  # rounding does not add up
    return np.maximum(widths, np.diff(ends, prepend=0))


def crowding(points: Floats, nets: Sequence[Sequence[int]], side: int) -> Floats:
    """By point its part of the wires around it: those of its square over the pins of the square, times its own.

    points: (n, 2). A net's wires are spread evenly over its box. side: of a square.
    """
    squares = (points // side).astype(np.int64)
    squares -= squares.min(axis=0)
    density = np.zeros(squares.max(axis=0) + 2)
    pins = np.zeros_like(density)
    for ends in nets:
        spot = points[ends]
        (left, low), (right, high) = squares[ends].min(axis=0), squares[ends].max(axis=0) + 1
        wire = np.ptp(spot, axis=0).sum() * (1 + MORE * (len(ends) - 2)) / ((right - left) * (high - low))
        density[left, low] += wire
        density[right, high] += wire
        density[left, high] -= wire
        density[right, low] -= wire
        np.add.at(pins, tuple(squares[ends].T), 1)
    density = density.cumsum(axis=0).cumsum(axis=1)
    own = np.bincount(np.concatenate([np.asarray(ends) for ends in nets]), minlength=len(points))
    at = tuple(squares.T)
    return density[at] * own / np.maximum(pins[at], 1)


def connections(plan: Plan, fixed: Collection[str], names: Collection[str]) -> dict[str, Ends]:
    """By net its ends: the number of a cell in ``names``, or a point (um). Without nets of one end or of ``fixed``."""
    numbers = {name: k for k, name in enumerate(names)}
    nets: dict[str, Ends] = {net: [at] for net, at in plan.ports.items()}
    for name, instance in plan.instances.items():
        for net in instance.pins.values():
            nets.setdefault(net, []).append(numbers.get(name, plan.point(name)))
    tied = {net for name in fixed for net in plan.instances[name].pins.values()}
    return {net: ends for net, ends in nets.items() if net not in tied and len(ends) > 1}
