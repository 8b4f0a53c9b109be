"""Drivers that are too weak for their nets get larger ones, or buffers behind them."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from talbot.platforms.coriolis import CoriolisPlatform

from ..geometry.rows import Place, Rows, free_rows
from ..netlist.buffering import clusters
from ..netlist.netlist import OUTPUT_PINS, Buffer, Instance, Netlist
from ..netlist.placed import MIRRORED
from .drive import Drives

BUFFER = Buffer("buf_x1", "i", "q")  # and its larger forms
ROUNDS = 8
BUFFER_NS = 0.5  # that a sink behind a buffer is later, about
OHM_UM, VIAS_OHM = 0.5, 30.0  # of a net: a um of wire, its vias
NEAR, HALF = 0.1, 0.5  # of the way from a driver to the middle of its sinks: its only buffer, one of many
FULL = 0.9  # of what the largest buffer drives, at most, in a group of sinks
MORE = 0.06  # of a net's length for each pin beyond two: the chip's capacitances as estimated, and as extracted
DETOUR, LITTLE = 2.0, 1.4  # wire that a larger driver is to bear, and one without a larger form, by the shortest
OWN, HALFWAY = "_repair", "_halfway"  # end the names of buffers that are inserted here
FAR_UM = 250.0
Point = tuple[float, float]  # um
End = tuple[str, str]  # instance and pin
Sinks = list[End]
Slacks = Mapping[End, float]  # ns


@dataclass
class Plan:
    """A placed netlist while it is repaired.

    instances, places: of all cells but fill, by name. widths: of the library's cells, um. rows: what is free.
    ports: where nets of ports end. femtofarad_um: of a wire. outside: pF by net of a port. Without these two no load.
    """

    instances: dict[str, Instance]
    places: dict[str, Place]
    widths: Mapping[str, float]
    rows: Rows
    ports: Mapping[str, Point]
    femtofarad_um: float = 0.0
    outside: Mapping[str, float] = field(default_factory=dict)
    added: int = 0

    def point(self, name: str) -> Point:
        """The middle of a cell; of a macro its origin."""
        x, y, orientation = self.places[name]
        across, up = MIRRORED[orientation]
        width = self.widths.get(self.instances[name].cell)
        return (x, y) if width is None else (x + across * width / 2, y + up * self.rows.height / 2)

    def put(self, instance: Instance, at: Point) -> bool:
        """Place a new ``instance`` near ``at``; False where there is no room."""
        width = self.widths[instance.cell]
        found = self.rows.take(width, at[0] - width / 2, at[1])
        if found:
            self.instances[instance.name], self.places[instance.name] = instance, found
        return found is not None

    def connect(self, ends: Sinks, net: str) -> None:
        """Connect pins to a net in place of theirs."""
        for name, pin in ends:
            was = self.instances[name]
            self.instances[name] = replace(was, pins=was.pins | {pin: net})

    def load(self, drives: Drives, net: str, points: Sequence[Point], sinks: Sinks, detour: float = 1.0) -> float:
        """Load (pF) of a wire over ``points``, the place of the net's port if it is one's, and ``sinks``.

        detour: how many times as long as it need be the wire is.
        """
        ends = [*points, *(self.point(name) for name, _ in sinks)]
        ends += [self.ports[net]] if net in self.ports else []
        pins = sum(drives.inputs.get((self.instances[name].cell, pin), 0.0) for name, pin in sinks)
        return length(ends) * detour * self.femtofarad_um / 1000 + pins + self.outside.get(net, 0.0)

    def lengths(self) -> dict[str, float]:
        """Estimated um of every net as it is placed now."""
        ends: dict[str, list[Point]] = {net: [at] for net, at in self.ports.items()}
        for name, instance in self.instances.items():
            for net in instance.pins.values():
                ends.setdefault(net, []).append(self.point(name))
        return {net: length(points) for net, points in ends.items()}

    def wires(self) -> dict[str, tuple[float, float]]:
        """(fF, ohm) of every net as it is placed now."""
        return {net: (self.femtofarad_um * um, OHM_UM * um + VIAS_OHM) for net, um in self.lengths().items()}

    def listed(
        self, netlist: Netlist, placed: Sequence[Sequence[Any]], fill: Sequence[str]
    ) -> tuple[Netlist, list[list[Any]]]:
        """Netlist and places ([number, cell, x, y, orientation]) of all cells, ``fill`` in what is free.

        netlist, placed: those before.
        """
        numbers = {i.name: place[0] for i, place in zip(netlist.instances, placed, strict=True)}
        made = [(i, [numbers.get(name), i.cell, *self.places[name]]) for name, i in self.instances.items()]
        for k, (cell, place) in enumerate(self.rows.filled({cell: self.widths[cell] for cell in fill})):
            made.append((Instance(f"fill_{k}", cell, {}), [None, cell, *place]))
        instances, places = zip(*made, strict=True)
        return replace(netlist, instances=instances), list(places)


def planned(
    netlist: Netlist,
    placement: Mapping[str, Any],
    floorplan: Mapping[str, Any],
    areas: Mapping[str, float],
    tech: CoriolisPlatform,
) -> Plan:
    """A placement as a Plan. areas: um2 by cell. floorplan, placement: as their steps write them."""
    widths = {cell: round(area / tech.row_um, 4) for cell, area in areas.items()}
    width, height = floorplan["width_um"], floorplan["height_um"]
    sides = {"west": lambda at: (0, at), "east": lambda at: (width, at)}
    sides |= {"south": lambda at: (at, 0), "north": lambda at: (at, height)}
    placed = zip(netlist.instances, placement["instances"], strict=True)
    working = [(instance, place) for instance, (_, _, *place) in placed if instance.pins]
    return Plan(
        instances={instance.name: instance for instance, _ in working},
        places={instance.name: tuple(place) for instance, place in working},
        widths=widths,
        rows=free_rows(placement["instances"], widths, tech.fill_cells, tech.site_um, tech.row_um),
        ports={net: sides[side](at) for side, net, at in placement["pins"]},
    )


def length(points: list[Point]) -> float:
    """Estimated length (um) of a net: half of its box's perimeter, more for more than two pins."""
    if len(points) < 2:
        return 0.0
    x, y = zip(*points, strict=True)
    return (max(x) - min(x) + max(y) - min(y)) * (1.0 + MORE * (len(points) - 2))


def clock_nets(instances: Collection[Instance]) -> set[str]:
    """All nets between the clock's port and the registers."""
    found = {instance.pins["clk"] for instance in instances if "clk" in instance.pins}
    drivers = {net: i for i in instances for pin, net in i.pins.items() if pin in OUTPUT_PINS}
    waiting = list(found)
    while waiting:
        driver = drivers.get(waiting.pop())
        pin = "clk" if driver and "clk" in driver.pins else "i"  # of a clock gate, of a buffer
        above = {driver.pins[pin]} if driver and pin in driver.pins else set[str]()
        waiting += above - found
        found |= above
    return found


def repaired(plan: Plan, drives: Drives, kept: Collection[str], slacks: Slacks | None = None) -> dict[str, int]:
    """Size and buffer until every driver's load is within its limit: how many cells were sized, how many buffers.

    kept: nets that stay as they are. slacks: ns of setup; of a net the sinks that can wait are buffered.
    """
    counts = {"sized": 0, "buffers": 0}
    for _ in range(ROUNDS):
        before = dict(counts)
        for net, (driver, pin, sinks) in connected(plan.instances).items():
            cell = plan.instances[driver].cell
            if net in kept or (cell, pin) not in drives.limits:
                continue
            load = plan.load(drives, net, [plan.point(driver)], sinks)
            if load <= drives.limits[cell, pin]:
                continue
            larger = drives.stronger(cell, pin, load)
            if larger:
                counts["sized"] += swap(plan, driver, larger)
            elif net in plan.outside:
                counts["buffers"] += drive_port(plan, drives, net, (driver, pin), load)
            else:
                counts["buffers"] += split(
                    plan, drives, net, driver, late(plan, drives, net, (driver, pin), sinks, slacks)
                )
        if counts == before:
            break
    return counts


def eased(plan: Plan, drives: Drives, kept: Collection[str]) -> int:
    """Let drivers that would not bear a detour of their nets be larger, or a buffer take the sinks; how many.

    A net that may go around others is in no other's way: the router finds more room, and fewer nets are too long.
    """
    count = 0
    for net, (driver, pin, sinks) in connected(plan.instances).items():
        cell = plan.instances[driver].cell
        if net in kept or net in plan.outside or (cell, pin) not in drives.limits:
            continue
        large, little = (plan.load(drives, net, [plan.point(driver)], sinks, detour) for detour in (DETOUR, LITTLE))
        if large <= drives.limits[cell, pin]:
            continue
        if (larger := drives.best(cell, pin, large)) != cell:
            count += swap(plan, driver, larger)
        elif little > drives.limits[cell, pin]:
            count += split(plan, drives, net, driver, sinks)
    return count


def borne(plan: Plan, drives: Drives) -> dict[str, float]:
    """Length (um) of every net at which its driver's load is at its limit."""
    made = {}
    for net, (driver, pin, sinks) in connected(plan.instances).items():
        limit = drives.limits.get((plan.instances[driver].cell, pin))
        if limit is not None:
            pins = sum(drives.inputs.get((plan.instances[name].cell, end), 0.0) for name, end in sinks)
            made[net] = round(max(limit - pins - plan.outside.get(net, 0.0), 0) * 1000 / plan.femtofarad_um, 3)
    return made


def shortened(plan: Plan, drives: Drives, kept: Collection[str]) -> int:
    """Put a buffer halfway to the sinks that are farther than FAR_UM from their driver or port; how many.

    A longer wire of one layer charges a small gate by more than a diode takes. kept: nets that stay as they are.
    """
    count, driven, sinks = 0, connected(plan.instances), sinks_of(plan.instances)
    limited = {net: name for net, (name, pin, _) in driven.items() if (plan.instances[name].cell, pin) in drives.limits}
    begins = {net: plan.point(name) for net, name in limited.items()}
    begins |= {net: at for net, at in plan.ports.items() if net not in driven}
    for net, (x, y) in begins.items():
        if net in kept:
            continue
        groups: dict[bool, Sinks] = {}  # to the west and to the east
        for end in sinks.get(net, ()):
            right, up = plan.point(end[0])
            if abs(right - x) + abs(up - y) > FAR_UM:
                groups.setdefault(right > x, []).append(end)
        for side, group in groups.items():
            right, up = np.mean([plan.point(name) for name, _ in group], axis=0)
            middle, far = ((x + float(right)) / 2, (y + float(up)) / 2), f"{net}_{('west', 'east')[side]}"
            cell = drives.best(BUFFER.cell, BUFFER.output, plan.load(drives, "", [middle], group))
            buffer = Instance(f"{far}{HALFWAY}", cell, {BUFFER.input: net, BUFFER.output: far})
            if plan.put(buffer, middle):
                plan.connect(group, far)
                count += 1
    return count


def late(plan: Plan, drives: Drives, net: str, driver: End, sinks: Sinks, slacks: Slacks | None) -> Sinks:
    """The sinks that can wait for a buffer, where the others alone are no load that is too large; else all."""
    if not slacks:
        return sinks
    least = min((slacks[end] for end in sinks if end in slacks), default=0.0)
    urgent = [end for end in sinks if slacks.get(end, np.inf) < least + BUFFER_NS]
    name, pin = driver
    load, rest = plan.load(drives, net, [plan.point(name)], urgent), set(urgent)
    within = load <= FULL * drives.limits[plan.instances[name].cell, pin]
    return [end for end in sinks if end not in rest] if within else sinks


def connected(instances: Mapping[str, Instance]) -> dict[str, tuple[str, str, Sinks]]:
    """By net its driver, the pin of it, and what it drives."""
    sinks = sinks_of(instances)
    drivers = {net: (name, pin) for name, i in instances.items() for pin, net in i.pins.items() if pin in OUTPUT_PINS}
    return {net: (*driver, sinks.get(net, [])) for net, driver in drivers.items()}


def sinks_of(instances: Mapping[str, Instance]) -> dict[str, Sinks]:
    """By net what it drives."""
    sinks: dict[str, Sinks] = {}
    for name, instance in instances.items():
        for pin, net in instance.pins.items():
            if pin not in OUTPUT_PINS:
                sinks.setdefault(net, []).append((name, pin))
    return sinks


def swap(plan: Plan, name: str, cell: str) -> bool:
    """Let the instance be another form of its cell; False where there is no room."""
    was, place, at = plan.instances[name], plan.places[name], plan.point(name)
    plan.rows.give(plan.widths[was.cell], place)
    if plan.put(replace(was, cell=cell), at):
        return True
    plan.put(was, at)
    return False


def drive_port(plan: Plan, drives: Drives, net: str, driver: End, load: float) -> int:
    """Insert a buffer between a driver and the net of an output, whose ``load`` (pF) it takes; how many."""
    name, pin = driver
    if name.endswith(OWN):
        return 0
    called, cell = f"{net}_{plan.added}", drives.best(BUFFER.cell, BUFFER.output, load)
    if not plan.put(BUFFER._replace(cell=cell).instance(f"{called}{OWN}", called, net), plan.point(name)):
        return 0
    plan.added += 1
    plan.connect([(name, pin)], called)
    return 1


def split(plan: Plan, drives: Drives, net: str, driver: str, sinks: Sinks) -> int:
    """Insert buffers between a net and its ``sinks``, near ones together; how many."""
    if not sinks or len(sinks) == 1 and sinks[0][0].endswith(OWN):
        return 0  # the port alone is left, or one buffer, which no other one would relieve
    start, points = plan.point(driver), np.array([plan.point(name) for name, _ in sinks])
    total = plan.load(drives, net, [start], sinks)
    most = FULL * drives.limits[drives.best(BUFFER.cell, BUFFER.output, np.inf), BUFFER.output]
    count = min(len(sinks), int(-(-total // most)))
    made = 0
    for group in clusters(points, -(-len(sinks) // count)):
        middle, ends = points[group].mean(axis=0), [sinks[k] for k in group]
        at = np.array(start) + (NEAR if count == 1 else HALF) * (middle - start)
        called = f"{net}_{plan.added}"
        cell = drives.best(BUFFER.cell, BUFFER.output, plan.load(drives, called, [(at[0], at[1])], ends))
        name = f"{called}{OWN}"
        if not plan.put(BUFFER._replace(cell=cell).instance(name, net, called), (at[0], at[1])):
            continue
        plan.added += 1
        plan.connect(ends, called)
        made += 1
    return made
