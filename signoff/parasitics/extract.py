"""Capacitance and resistor tree of every net of a netlist, from its finished layout.

All shapes count: routed segments, cells and metal fill. A cell's Liberty has the capacitance that its pins' nets have
in the cell alone; that, extracted from the cell in the same way, is subtracted, so that a net has what its layout adds:
its segments, what runs over and beside the cells, cells beside one another, less what these shield. Coupling counts as
to ground, a factor of 1. Metal of no net (fill) floats: of the capacitance c to a square that has t in all, c (1 - c/t)
remains, as if what else is around that square were ground.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from talbot.base.gds import db
from talbot.platforms.extraction import ExtractionPlatform
from talbot.platforms.layout import LayoutPlatform
from talbot.platforms.wires import Wires
from talbot.signoff.netlist.netlist import OUTPUT_PINS, Netlist
from talbot.signoff.parasitics.capacitance import Capacitances, Flags, Floats, Numbers, capacitances
from talbot.signoff.parasitics.nets import Place, places
from talbot.signoff.parasitics.shapes import METAL_LEVEL, Shapes, labels, shapes
from talbot.signoff.parasitics.spef import Tree
from talbot.signoff.parasitics.trees import Trees, trees


def extract(
    layout: "db.Layout",
    netlist: Netlist,
    placement: Path,
    tech: LayoutPlatform,
    devices: ExtractionPlatform,
    corners: Sequence[Wires],
) -> Iterator[dict[str, Tree]]:
    """The nets of ``netlist`` at each of ``corners``, by name. Raises StepError, see `places`."""
    found = shapes(layout, layout.top_cell(), tech, devices)
    nets = places(netlist, placement, layout, tech, found)
    cells = {place.cell for ends in nets.values() for place in ends if place.cell}
    inside = {cell: pin_capacitances(layout, cell, tech, devices, corners) for cell in cells}
    numbers = np.array([found.nets[ends[0].box] for ends in nets.values()])
    floats = floating(found, numbers)
    vias = [devices.vias[0].lef, *(via.lef for via in tech.vias)]
    pins = [place for ends in nets.values() for place in ends]
    first = np.cumsum([0, *map(len, nets.values())])
    roots = [int(k) + _driver(netlist, ends) for k, ends in zip(first, nets.values())]
    for n, (wires, all_of_it) in enumerate(zip(corners, capacitances(found, corners, floats), strict=True)):
        own = with_fill_floating(found, all_of_it, floats)
        made = trees(found, own, wires, vias, [(pin.box, *pin.at) for pin in pins], roots)
        in_cell = np.array([inside[pin.cell][pin.pin[1]][n] if pin.cell else 0.0 for pin in pins])
        less = np.maximum(np.bincount(found.nets, own)[numbers] - np.add.reduceat(in_cell, first[:-1]), 0.0)
        yield dict(zip(nets, _named(made, pins, first, in_cell, less), strict=True))


def floating(found: Shapes, driven: Numbers) -> Flags:
    """Whether a net floats: it touches neither poly nor diffusion, and is none of the nets ``driven``."""
    floats = np.ones(found.net_count, np.bool_)
    floats[found.nets[found.levels < METAL_LEVEL]] = False
    floats[driven] = False
    return floats


def with_fill_floating(found: Shapes, all_of_it: Capacitances, floats: Flags) -> Floats:
    """Capacitance (fF) of each box to all that does not float; boxes of nets that do have 0. floats: of each net."""
    floats = np.append(floats, False)
    total = np.bincount(found.nets, all_of_it.own, found.net_count + 1)
    lost = np.zeros(found.net_count + 1)
    for net, other in ((0, 1), (1, 0)):
        fill = floats[all_of_it.pairs[:, other]]
        at, c = all_of_it.pairs[fill], all_of_it.coupling[fill]
        lost += np.bincount(at[:, net], c**2 / total[at[:, other]], found.net_count + 1)
    rest = np.where(floats, 0.0, 1 - lost / np.maximum(total, 1e-30))
    return all_of_it.own * rest[found.nets]


def pin_capacitances(
    layout: "db.Layout", cell: str, tech: LayoutPlatform, devices: ExtractionPlatform, corners: Sequence[Wires]
) -> dict[str, list[float]]:
    """Capacitance in fF, at each of ``corners``, of the nets of a ``cell`` alone, by the texts on them."""
    found = shapes(layout, layout.cell(cell), tech, devices)
    at = {name: found.nets[found.at(*points[0])] for name, points in labels(layout, layout.cell(cell), tech).items()}
    floats = floating(found, np.array(list(at.values()), np.int64))
    all_of_it = capacitances(found, corners, floats)
    totals = [np.bincount(found.nets, with_fill_floating(found, one, floats)) for one in all_of_it]
    return {name: [float(total[net]) for total in totals] for name, net in at.items()}


def _driver(netlist: Netlist, ends: Sequence[Place]) -> int:
    """Which of a net's pins drives it; the first one where that is a macro's."""
    inputs = {net for port in netlist.ports if port.direction == "input" for net in port.bits()}
    drives = (end.pin[1] in (inputs if not end.cell else OUTPUT_PINS) for end in ends)
    return next((k for k, one in enumerate(drives) if one), 0)


def _named(made: Trees, pins: Sequence[Place], first: Numbers, in_cell: Floats, totals: Floats) -> Iterator[Tree]:
    """The tree of each net, whose pins begin at ``first``; its nodes, less the cells' part, add to ``totals``."""
    charge = made.femtofarad.copy()
    charge[made.pins] = np.maximum(charge[made.pins] - in_cell, 0.0)
    kept = np.flatnonzero(made.kept)
    names = {int(node): pin.pin for node, pin in zip(made.pins, pins, strict=True)}
    root = {}
    nodes: dict[int, list[int]] = {}
    for node in kept[np.argsort(made.distance[kept], kind="stable")].tolist():
        parent = int(made.parents[node])
        root[node] = root[parent] if parent >= 0 else node
        nodes.setdefault(root[node], []).append(node)
    for begin, end, total in zip(first[:-1], first[1:], totals, strict=True):
        own = nodes[next(root[int(node)] for node in made.pins[begin:end])]
        called = {node: names.get(node, k) for k, node in enumerate(own, 1)}
        whole = charge[own].sum()
        share = charge[own] / whole if whole else np.full(len(own), 1 / len(own))
        branches = [(called[int(made.parents[k])], called[k], float(made.ohm[k])) for k in own if made.parents[k] >= 0]
        yield Tree(float(total), dict(zip(called.values(), (share * total).tolist())), branches)
