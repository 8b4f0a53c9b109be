"""The characterization of one cell at one corner: what a Liberty library is written from."""

import resource
import time
from types import ModuleType
from typing import NamedTuple

import numpy as np

from talbot.cells.characterize import delay, tristate
from talbot.cells.characterize.bench import Bench
from talbot.cells.characterize.capacitance import capacitance
from talbot.cells.characterize.conditions import Conditions
from talbot.cells.characterize.constraint import constraints
from talbot.cells.characterize.grid import Axis, refined
from talbot.cells.characterize.leakage import leakage
from talbot.cells.characterize.measured import ArcTables, Measured, arc_tables
from talbot.cells.characterize.power import quiet_energy
from talbot.cells.characterize.tries import Tries
from talbot.cells.netlist.function import Arc, Cell

LETS_GO = "three_state_disable"


def characterize(cell: Cell, process: ModuleType, conditions: Conditions) -> Measured:
    """Everything about ``cell`` under ``conditions``. process: a module like platforms.sky130.models."""
    started, used, tried = time.monotonic(), cpu_seconds(), Tries()
    machine = cell.machine
    with Bench(cell, process, conditions) as bench:
        tried_axes = {output: tried(f"{output}: axes", axes_of, bench, output) for output in machine.outputs}
        axes = {output: axis for output, axis in tried_axes.items() if axis}
        for output, axis in axes.items():
            bench.middle[output] = _between(conditions.least_load, axis.limit, 1 / 2)
            bench.pressed[output] = _between(conditions.least_load, axis.limit, 2 / 3)
        edges = [arc for arc in cell.arcs if arc.output in axes and arc.type != LETS_GO]
        names = [f"{arc.pin} {arc.pin_edge} to {arc.output} {arc.edge}" for arc in edges]
        arcs = [
            tried(n, _arc, bench, a, axes[a.output].slews, axes[a.output].loads)
            for n, a in zip(names, edges, strict=True)
        ]
        measured: Measured = {
            "name": cell.name,
            "failed": tried.failed,
            "slews": conditions.slews,
            "longest_slew": conditions.longest_slew,
            "largest_load": {output: axis.limit for output, axis in axes.items()},
            "interpolation_error": {output: axis.error for output, axis in axes.items()},
            "arcs": [arc for arc in arcs if arc],
            "capacitance": {pin: tried(f"{pin}: capacitance", capacitance, bench, pin) for pin in machine.inputs},
            "quiet_energy": {pin: tried(f"{pin}: energy", quiet_energy, bench, pin) for pin in machine.inputs},
            "constraints": [],
            "leakage": [],
            "simulations": 0,
            "repeated": 0,
            "wall_s": 0.0,
            "cpu_s": 0.0,
        }
        _without_pin(measured)
        if cell.storage:
            measured["constraints"] = constraints(bench, tried)
        _let_go(measured, bench, process, axes, tried)
    with Bench(cell, process, conditions, leakage=True) as still:
        measured["leakage"] = tried("leakage", leakage, still) or []
    for simulated in (bench, still):
        measured["simulations"] += simulated.simulator.runs
        measured["repeated"] += simulated.simulator.repeated
    measured["wall_s"], measured["cpu_s"] = round(time.monotonic() - started, 2), round(cpu_seconds() - used, 2)
    return measured


def cpu_seconds() -> float:
    """CPU seconds of this process and of its children that have ended."""
    parts = map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(part.ru_utime + part.ru_stime for part in parts)


class Axes(NamedTuple):
    """Slews (s), loads (F) and interpolation error of an output's tables; limit: F at Conditions.longest_slew."""

    slews: Axis
    loads: Axis
    error: float
    limit: float


def axes_of(bench: Bench, output: str) -> Axes:
    """The axes of ``output``; loads end where the slower edge reaches the last of Conditions.slews."""
    arcs = [arc for arc in bench.cell.arcs if arc.output == output and not arc.type.startswith("three_state")]
    number = bench.machine.outputs.index(output)
    edges = list({arc.changes[0].after.outputs[number]: arc.changes[0] for arc in arcs}.values())
    c = bench.conditions
    end, limit = (delay.largest_load(bench, edges, output, slew) for slew in (c.slews[-1], c.longest_slew))
    return Axes(*refined(bench, edges, output, delay.load_axis(c, end)), limit)


def _between(least: float, most: float, share: float) -> float:
    """The F at a ``share`` of the way from ``least`` to ``most``, by factors."""
    return float(least ** (1 - share) * most**share)


def _arc(bench: Bench, arc: Arc, slews: Axis, loads: Axis) -> ArcTables:
    change = delay.chosen(bench, arc, loads[len(loads) // 2])
    values = delay.table(bench, change, arc.output, loads, slews).values
    tables = arc_tables(arc, slews, loads, change.before, values["delay"].tolist(), values["slew"].tolist())
    return {**tables, "energy": values["energy"].tolist()}


def _let_go(measured: Measured, bench: Bench, process: ModuleType, axes: dict[str, Axes], tried: Tries) -> None:
    """Add what is measured of outputs that are let go."""
    for output, (slews, loads, *_) in axes.items():
        arcs = [arc for arc in bench.cell.arcs if arc.output == output and arc.type == LETS_GO]
        if not arcs:
            continue
        with tristate.Held(bench, output, process) as held:
            measured["capacitance"][output] = tried(f"{output}: capacitance", held.capacitance)
            for arc in arcs:
                release = tried(f"{arc.pin} {arc.pin_edge} lets {output} go", tristate.disable, held, arc, slews, loads)
                measured["arcs"] += [release] if release else []
            measured["simulations"] += held.simulator.runs
            measured["repeated"] += held.simulator.repeated


def _without_pin(measured: Measured) -> None:
    """Take what an input's edge alone needs off the energy of the edges that it causes: the pin has that."""
    for arc in measured["arcs"]:
        alone = measured["quiet_energy"].get(arc["pin"])
        if alone and "energy" in arc:
            quiet = np.interp(arc["slews"], measured["slews"], alone[arc["pin_edge"]])
            arc["energy"] = (np.array(arc["energy"]) - quiet[:, None]).tolist()
