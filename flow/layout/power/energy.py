"""Power of every cell from the transitions on its nets, a Liberty's tables and the nets' parasitic capacitance.

OpenSTA has this too, but Debian's 2.0.17 counts both energies of an output at each of its transitions (twice what the
Liberty says), takes activities for some pins only, and its `set_power_activity -pins` ends in an error.
"""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from talbot.base.liberty.group import Group
from talbot.base.steps import StepError
from talbot.signoff.netlist.netlist import OUTPUT_PINS, Instance, Netlist, is_register

CLOCK = re.compile("clk|ck|CLK")  # pins
SLEW_NS = 0.1  # of a pin that OpenSTA has no slew for: constants
Energy = Callable[[float, float], float]  # (slew ns, load pF) -> pJ
Activity = Mapping[str, tuple[float, float]]  # net -> (transitions a cycle, share of time at 1)
Sinks = Mapping[str, list[tuple[Instance, str]]]  # net -> (instance, pin) that it leads to
Slews = Mapping[tuple[str, str], float]  # (instance, pin) -> ns


@dataclass(frozen=True)
class Cells:
    """The cells of a Liberty, tables in ns, pF, pJ, nW. library: its outermost group."""

    library: Group

    @cached_property
    def cells(self) -> dict[str, Group]:
        """Groups of the cells, by name."""
        return {group.name: group for group in self.library.all("cell")}

    @cached_property
    def pins(self) -> dict[tuple[str, str], Group]:
        """Groups of the pins, by (cell, pin)."""
        return {(name, pin.name): pin for name, cell in self.cells.items() for pin in cell.all("pin")}

    @property
    def supply_v(self) -> float:
        """Nominal supply, V."""
        return self.library.number("nom_voltage")

    def leakage_nw(self, cell: str) -> float:
        """Leakage of a cell, nW; 0 for one that the Liberty does not have."""
        return self.cells[cell].number("cell_leakage_power", 0.0) if cell in self.cells else 0.0

    def capacitance_pf(self, cell: str, pin: str) -> float:
        """Capacitance of a pin, pF; 0 for one that the Liberty does not have."""
        found = self.pins.get((cell, pin))
        return found.number("capacitance", 0.0) if found else 0.0

    def energies(self, cell: str, pin: str) -> list[tuple[str, Energy]]:
        """Pairs (related pin or '', energy of a transition, the mean of both edges) of a pin."""
        key = cell, pin
        if key not in self._energies:
            tables = self.pins[key].all("internal_power") if key in self.pins else ()
            self._energies[key] = [(power.text("related_pin"), _mean(power)) for power in tables]
        return self._energies[key]

    @cached_property
    def _energies(self) -> dict[tuple[str, str], list[tuple[str, Energy]]]:
        return {}


def _mean(power: Group) -> Energy:
    """Mean of the tables of an internal_power group."""
    tables = [_interpolated(table) for kind in ("rise_power", "fall_power") if (table := power.one(kind))]
    return lambda slew, load: sum(table(slew, load) for table in tables) / max(1, len(tables))


def _interpolated(table: Group) -> Energy:
    """Interpolate a table with one or two indices; constant beyond the grid."""
    values = table.array("values")
    slews = table.array("index_1") if "index_1" in table.attributes else np.zeros(1)
    if "index_2" not in table.attributes:
        return lambda slew, load: float(np.interp(slew, slews, np.ravel(values)))
    loads, grid = table.array("index_2"), np.reshape(values, (len(slews), -1))

    def at(slew: float, load: float) -> float:
        load = min(max(load, loads[0]), loads[-1])
        return float(np.interp(slew, slews, [np.interp(load, loads, row) for row in grid]))

    return at


@dataclass(frozen=True)
class Power:
    """Power of one instance, uW."""

    internal: float
    switching: float
    leakage: float

    @property
    def total(self) -> float:
        """Sum of the parts."""
        return self.internal + self.switching + self.leakage


def powers(
    netlist: Netlist, cells: Cells, activity: Activity, wire_pf: Mapping[str, float], slews: Slews, period_ns: float
) -> dict[str, Power]:
    """Power of every instance with pins, by name.

    wire_pf: net -> pF. Raises StepError for a net without activity.
    """
    load = dict(wire_pf)
    for instance in netlist.instances:
        for pin, net in instance.pins.items():
            load[net] = load.get(net, 0.0) + cells.capacitance_pf(instance.cell, pin)
    lost = sorted({net for i in netlist.instances for net in i.pins.values()} - set(activity))
    if lost:
        raise StepError(f"power: no activity of the nets {', '.join(lost[:5])}")
    mega = 1000 / period_ns  # cycles a us: pJ a cycle to uW
    return {i.name: _power(i, cells, activity, load, slews, mega) for i in netlist.instances if i.pins}


def _power(
    instance: Instance, cells: Cells, activity: Activity, load: Mapping[str, float], slews: Slews, mega: float
) -> Power:
    internal = switching = 0.0
    for pin, net in instance.pins.items():
        toggles = activity[net][0]
        group = cells.pins.get((instance.cell, pin))
        output = group is not None and group.text("direction") == "output"
        energies = cells.energies(instance.cell, pin)
        weights = [activity[instance.pins[related]][0] if related in instance.pins else 1.0 for related, _ in energies]
        if not sum(weights):
            weights = [1.0] * len(weights)
        for weight, (related, energy) in zip(weights, energies, strict=True):
            share = weight / sum(weights) if output else 1.0
            slew = slews.get((instance.name, related or pin), SLEW_NS)
            internal += toggles * share * energy(slew, load[net] if output else 0.0) * mega
        if output:
            switching += 0.5 * load[net] * cells.supply_v**2 * toggles * mega
    return Power(internal, switching, cells.leakage_nw(instance.cell) / 1000)


def blocks(netlist: Netlist) -> dict[str, str]:
    """Map each instance to a block: of a register, the first part of its name; of a cell, that of most that it drives.

    A cell that only drives clocks is in 'clock tree', one that drives nothing but ports in 'ports'; what makes the
    enable of a clock gate belongs to the registers behind it.
    """
    sinks: dict[str, list[tuple[Instance, str]]] = {}
    for instance in netlist.instances:
        for pin, net in instance.pins.items():
            if pin not in OUTPUT_PINS:
                sinks.setdefault(net, []).append((instance, pin))
    registers = [i.name for i in netlist.instances if is_register(i.cell)]
    found = {name: name.partition(".")[0] if "." in name else "top" for name in registers}
    for start in netlist.instances:
        stack = [start] if start.pins else []
        while stack:
            instance = stack[-1]
            after = [end for sink, pin in _after(instance, sinks) for end in _enabled(sink, pin, sinks)]
            todo = [sink for sink, _ in after if sink.name not in found and sink not in stack]
            if instance.name in found or not todo:
                found.setdefault(instance.name, _most(after, found))
                stack.pop()
            else:
                stack.append(todo[0])
    return found


def _after(instance: Instance, sinks: Sinks) -> list[tuple[Instance, str]]:
    return [sink for pin, net in instance.pins.items() if pin in OUTPUT_PINS for sink in sinks.get(net, ())]


def _enabled(sink: Instance, pin: str, sinks: Sinks) -> list[tuple[Instance, str]]:
    """The pin itself, or of a clock gate's enable the outputs of the registers behind the gate."""
    behind = _after(sink, sinks)
    gate = behind and all(CLOCK.fullmatch(end) for _, end in behind) and any(map(CLOCK.fullmatch, sink.pins))
    return [(register, "") for register, _ in behind] if gate and not CLOCK.fullmatch(pin) else [(sink, pin)]


def _most(after: list[tuple[Instance, str]], found: Mapping[str, str]) -> str:
    votes: dict[str, int] = {}
    for sink, pin in after:
        clock = CLOCK.fullmatch(pin) or found.get(sink.name) == "clock tree"
        name = "clock tree" if clock else found.get(sink.name, "ports")
        votes[name] = votes.get(name, 0) + 1
    return max(sorted(votes), key=votes.__getitem__) if votes else "ports"
