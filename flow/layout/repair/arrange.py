"""Cells placed for short wires, by Coloquinte, in the rows of a placement."""

from collections.abc import Collection

import coloquinte
from coloquinte import CellOrientation, CellRowPolarity, ColoquinteParameters, Rectangle, Row

from ..netlist.placed import MIRRORED
from .repair import Plan, length

FULL = 0.95  # of the rows, at most: cells, and what is kept free beside each, by its pins
SEED = 1


def arranged(plan: Plan, fixed: Collection[str], effort: int, spread: float) -> None:
    """Place all cells of the library but ``fixed`` again, for short nets, those of ``fixed`` left out.

    effort: of the placer, 1..9. spread: of what is empty, the share between cells.
    """
    names = [name for name, i in plan.instances.items() if name not in fixed and i.cell in plan.widths]
    for name in names:
        plan.rows.give(plan.widths[plan.instances[name].cell], plan.places[name])
    nets = connections(plan, fixed, names)
    site, height = plan.rows.site, plan.rows.height
    tall = round(height / site)  # the placer's unit is a site; a row is a whole number of them high, or nearly
    held = sorted({end for ends in nets.values() for end in ends if not isinstance(end, int)})
    numbers = {end: len(names) + k for k, end in enumerate(held)}
    widths = [round(plan.widths[plan.instances[name].cell] / site) for name in names]
    lows = {round((y + min(0, MIRRORED[way][1]) * height) / height) * tall: (y, way) for y, way in plan.rows.rows}

    circuit = coloquinte.Circuit(len(names) + len(held))
    points = [*(plan.point(name) for name in names), *held]
    zeros = [0 for _ in held]
    circuit.cell_width, circuit.cell_height = [*widths, *zeros], [*(tall for _ in names), *zeros]
    sizes = list(zip(circuit.cell_width, circuit.cell_height, strict=True))
    circuit.cell_x = [round(x / site) - wide // 2 for (x, _), (wide, _) in zip(points, sizes, strict=True)]
    circuit.cell_y = [round(y / height * tall) - high // 2 for (_, y), (_, high) in zip(points, sizes, strict=True)]
    circuit.cell_is_fixed = [high == 0 for _, high in sizes]
    circuit.cell_is_obstruction = [high > 0 for _, high in sizes]
    circuit.cell_row_polarity = [CellRowPolarity.SAME for _ in sizes]
    circuit.rows = [
        Row(Rectangle(begin, end, low, low + tall), CellOrientation.N)
        for low, row in lows.items()
        for begin, end in plan.rows.rows[row]
    ]
    for ends in nets.values():
        which = [end if isinstance(end, int) else numbers[end] for end in ends]
        circuit.add_net(which, *([size // 2 for size in axis] for axis in zip(*(sizes[k] for k in which), strict=True)))
    there = sum(end - begin for spans in plan.rows.rows.values() for begin, end in spans)
    ends = [len(plan.instances[name].pins) for name in names]
    beside = spread * max(0.0, FULL * there - sum(widths)) / sum(ends)
    circuit.cell_width = [*(wide + round(beside * many) for wide, many in zip(widths, ends, strict=True)), *zeros]
    parameters = ColoquinteParameters(effort, SEED)
    circuit.place_global(parameters)
    circuit.cell_width = [*widths, *zeros]
    circuit.legalize(parameters)
    circuit.place_detailed(parameters)
    for name, x, low in zip(names, circuit.cell_x, circuit.cell_y, strict=False):
        place = round(x * site, 4), *lows[low]
        plan.rows.claim(plan.widths[plan.instances[name].cell], place)
        plan.places[name] = place


def connections(
    plan: Plan, fixed: Collection[str], names: Collection[str]
) -> dict[str, list[int | tuple[float, float]]]:
    """By net its ends: the number of a cell in ``names``, or a point (um). Without nets of one end or of ``fixed``."""
    numbers = {name: k for k, name in enumerate(names)}
    nets: dict[str, list[int | tuple[float, float]]] = {net: [at] for net, at in plan.ports.items()}
    for name, instance in plan.instances.items():
        for net in instance.pins.values():
            nets.setdefault(net, []).append(numbers.get(name, plan.point(name)))
    tied = {net for name in fixed for net in plan.instances[name].pins.values()}
    return {net: ends for net, ends in nets.items() if net not in tied and len(ends) > 1}


def wire_um(plan: Plan) -> float:
    """Estimated length of all nets, um."""
    ends = connections(plan, (), ())
    return sum(length([end for end in points if not isinstance(end, int)]) for points in ends.values())
