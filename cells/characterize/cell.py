"""Everything about one cell at one corner, as plain data that JSON holds: what Liberty is written from."""

import resource
import time

import numpy as np

from cells.characterize import delay, grid, tristate
from cells.characterize.bench import Bench
from cells.characterize.capacitance import capacitance
from cells.characterize.constraint import constraints
from cells.characterize.leakage import leakage
from cells.characterize.power import quiet_energy
from cells.spice.engine import SimulationError

LETS_GO = "three_state_disable"


def characterize(cell, process, conditions):
    """dict: what `cells.liberty.build` takes, with SI units, 'failed' (what, why, deck), counts and seconds.

    wall_s: by the clock; cpu_s: of this process and of ngspice.
    """
    started, used = time.monotonic(), cpu_seconds()
    out = {"name": cell.name, "failed": [], "slews": conditions.slews}
    with Bench(cell, process, conditions) as bench:
        tried = _Tries(out["failed"])
        axes = {output: tried(f"{output}: axes", axes_of, bench, output) for output in cell.machine.outputs}
        for output, axis in axes.items():
            if axis:
                bench.middle[output] = _between(axis[1], 1 / 2)
                bench.pressed[output] = _between(axis[1], 2 / 3)
        out["largest_load"] = {output: axis[1][-1] for output, axis in axes.items() if axis}
        out["interpolation_error"] = {output: axis[2] for output, axis in axes.items() if axis}
        out["arcs"] = [
            tried(f"{arc.pin} {arc.pin_edge} to {arc.output} {arc.edge}", _arc, bench, arc, *axes[arc.output][:2])
            for arc in cell.arcs
            if axes[arc.output] and arc.type != LETS_GO
        ]
        out["arcs"] = [arc for arc in out["arcs"] if arc]
        out["capacitance"] = {pin: tried(f"{pin}: capacitance", capacitance, bench, pin) for pin in cell.machine.inputs}
        out["quiet_energy"] = {
            pin: _lists(tried(f"{pin}: energy", quiet_energy, bench, pin)) for pin in cell.machine.inputs
        }
        _without_clock(out, cell)
        out["constraints"] = constraints(bench, tried) if cell.storage else []
        runs, repeated = _let_go(out, bench, process, axes, tried)
    with Bench(cell, process, conditions, leakage=True) as bench:
        out["leakage"] = tried("leakage", leakage, bench) or []
    out["simulations"], out["repeated"] = runs + bench.simulator.runs, repeated + bench.simulator.repeated
    out["wall_s"], out["cpu_s"] = round(time.monotonic() - started, 2), round(cpu_seconds() - used, 2)
    return out


def cpu_seconds():
    """Processor's seconds of this process and of its children that have ended."""
    return sum(
        part.ru_utime + part.ru_stime
        for part in map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    )


class _Tries:
    """Calls whose SimulationError is written down with its netlist instead of ending the cell."""

    def __init__(self, failed):
        self.failed = failed

    def __call__(self, what, call, *arguments):
        try:
            return call(*arguments)
        except SimulationError as error:
            self.failed.append({"what": what, "why": str(error), "deck": error.deck})
            return None


def _lists(arrays):
    return arrays and {name: values.tolist() for name, values in arrays.items()}


def axes_of(bench, output):
    """(slews, loads, interpolation error) of ``output``; loads end where the slower edge reaches the longest slew."""
    changes = [
        arc.changes[0] for arc in bench.cell.arcs if arc.output == output and not arc.type.startswith("three_state")
    ]
    number = bench.machine.outputs.index(output)
    edges = list({change.after.outputs[number]: change for change in changes}.values())
    loads = delay.load_axis(bench.conditions, delay.largest_load(bench, edges, output))
    return grid.refined(bench, edges, output, loads)


def _between(loads, share):
    """F at a ``share`` of an axis, by its ends: more points in it change nothing."""
    return float(loads[0] ** (1 - share) * loads[-1] ** share)


def _arc(bench, arc, slews, loads):
    change = delay.slowest(bench, arc, loads[len(loads) // 2])
    table = delay.table(bench, change, arc.output, loads, slews)
    return {
        **_named(arc),
        "slews": table.slews,
        "loads": table.loads,
        "state": list(change.before.inputs),
        **_lists(table.values),
    }


def _named(arc):
    return {name: getattr(arc, name) for name in ("pin", "pin_edge", "output", "edge", "type", "sense")}


def _let_go(out, bench, process, axes, tried):
    """Add to ``out`` what is measured of outputs that are let go: (transients, repeated ones) of the cell so far."""
    runs, repeated = bench.simulator.runs, bench.simulator.repeated
    for output, axis in axes.items():
        arcs = [arc for arc in bench.cell.arcs if arc.output == output and arc.type == LETS_GO]
        if not arcs or not axis:
            continue
        with tristate.Held(bench, output, process) as held:
            out["capacitance"][output] = tried(f"{output}: capacitance", held.capacitance)
            for arc in arcs:
                found = tried(f"{arc.pin} {arc.pin_edge} lets {arc.output} go", tristate.disable, held, arc, *axis[:2])
                out["arcs"] += [{**_named(arc), **found}] if found else []
            runs, repeated = runs + held.simulator.runs, repeated + held.simulator.repeated
    return runs, repeated


def _without_clock(out, cell):
    """Take what the clock's edge alone needs off the energy of the edges that it triggers: the pin has that."""
    slews = out["slews"]
    for arc in out["arcs"]:
        alone = out["quiet_energy"].get(arc["pin"])
        if arc["type"] in ("rising_edge", "falling_edge") and alone:
            clock = np.interp(arc["slews"], slews, alone[arc["pin_edge"]])
            arc["energy"] = (np.array(arc["energy"]) - clock[:, None]).tolist()
