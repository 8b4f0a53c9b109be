"""Registers behind clock gates and buffers that are near them, as many of these as the placement asks for."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from talbot.base.steps import StepError

from ..coriolis.leaves import assigned
from ..netlist.buffering import clusters
from ..netlist.gating import ClockCells
from ..netlist.netlist import Instance, is_register
from .drive import Drives
from .repair import End, Plan, Point, Sinks, connected, swap


class _Kind(NamedTuple):
    """Clock gates, or buffers. cells: the weakest first. clock, output: pins."""

    cells: tuple[str, ...]
    clock: str
    output: str


class _Group(NamedTuple):
    """Pins that a gate or a buffer is to drive: its place, and its load (pF)."""

    ends: Sinks
    middle: Point
    load: float


def regrouped(plan: Plan, drives: Drives, sizes: Sequence[ClockCells], most: int) -> int:
    """Group the registers of each enable, and those without one, by their places; how many drivers were added.

    Every group has a gate or a buffer in its middle (see `netlist.gating.drive_registers`), is of ``most`` registers at
    most and no load that is too large for the last of ``sizes``. The tree's leaves get about as many of these each, and
    every driver of the tree the size that its load asks for.
    Raises StepError where a driver has no room.
    """
    gate, buffer = sizes[0].gate, sizes[0].buffer
    kinds = (
        _Kind(tuple(cells.gate.cell for cells in sizes), gate.clock, gate.output),
        _Kind(tuple(cells.buffer.cell for cells in sizes), buffer.input, buffer.output),
    )
    nets = connected(plan.instances)
    branches = sorted({i.pins[gate.clock] for i in plan.instances.values() if is_register(i.cell)} & set(nets))
    groups: dict[tuple[_Kind, frozenset[End]], list[Instance]] = {}  # by the net of the enable
    for driver in (plan.instances[nets[net][0]] for net in branches):
        for kind in (kind for kind in kinds if driver.cell in kind.cells):
            enable = frozenset(driver.pins.items()) - {(pin, driver.pins[pin]) for pin in (kind.clock, kind.output)}
            groups.setdefault((kind, enable), []).append(driver)
    made, leaves = list[tuple[str, str]](), set[str]()
    for (kind, _), drivers in groups.items():
        sinks = [name for driver in drivers for name, _ in nets[driver.pins[kind.output]][2]]
        leaves |= {driver.pins[kind.clock] for driver in drivers}
        made += [(name, kind.clock) for name in _behind(plan, drives, kind, drivers, sinks, gate.clock, most)]
    ends = sorted(leaves)
    there = [plan.point(nets[net][0]) if net in nets else plan.ports[net] for net in ends]
    numbers = assigned([plan.point(name) for name, _ in made], there) if made else []
    loads: dict[str, Sinks] = {}
    for end, number in zip(made, numbers, strict=True):
        loads.setdefault(ends[number], []).append(end)
    for net, sinks in loads.items():
        plan.connect(sinks, net)
    level = [net for net in loads if net in nets]  # the port's is driven from outside
    while level:  # the leaves, then what drives them, up to the port
        for net in level:
            driver, pin, sinks = nets[net]
            load = plan.load(drives, net, [plan.point(driver)], loads.get(net, sinks))
            swap(plan, driver, drives.best(plan.instances[driver].cell, pin, load))
        level = sorted({plan.instances[nets[net][0]].pins[buffer.input] for net in level} & nets.keys())
    return len(made) - sum(map(len, groups.values()))


def _behind(
    plan: Plan, drives: Drives, kind: _Kind, drivers: list[Instance], registers: list[str], clock: str, most: int
) -> list[str]:
    """Put ``registers``, by their pin ``clock``, behind new drivers in place of ``drivers``; the names of the new."""
    ends = [(name, clock) for name in registers]
    limits = {cell: drives.limits[cell, kind.output] for cell in kind.cells}
    count = -(-len(ends) // most)
    groups = _groups(plan, drives, ends, count)
    while count < len(ends) and max(group.load for group in groups) > max(limits.values()):
        count += 1
        groups = _groups(plan, drives, ends, count)
    for driver in drivers:
        plan.rows.give(plan.widths[driver.cell], plan.places.pop(driver.name))
        del plan.instances[driver.name]
    names, first = list[str](), drivers[0]
    for k, group in enumerate(groups):
        cell = next((cell for cell, limit in limits.items() if limit >= group.load), kind.cells[-1])
        name, net = f"{first.name}_{k}", f"{first.pins[kind.output]}_{k}"
        if not plan.put(Instance(name, cell, first.pins | {kind.output: net}), group.middle):
            raise StepError(f"no room in the rows for {name}, which drives the clock of {len(group.ends)} registers")
        plan.connect(group.ends, net)
        names.append(name)
    return names


def _groups(plan: Plan, drives: Drives, ends: Sinks, count: int) -> list[_Group]:
    """``count`` groups, about, of near ones among ``ends``."""
    points, made = np.array([plan.point(name) for name, _ in ends]), list[_Group]()
    for numbers in clusters(points, -(-len(ends) // count)):
        x, y = points[numbers].mean(axis=0)
        middle, group = (float(x), float(y)), [ends[int(k)] for k in numbers]
        made.append(_Group(group, middle, plan.load(drives, "", [middle], group)))
    return made
