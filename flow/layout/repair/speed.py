"""Late paths made faster net by net: a larger driver, a buffer for the sinks that can wait, a buffer for all."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np

from talbot.base.liberty.group import Group

from .drive import Curve, Drives, over_loads
from .repair import BUFFER, BUFFER_NS, NEAR, OWN, End, Plan, Sinks, Slacks, connected, split, swap

SLEW_NS = 0.2  # of the input, for a cell's delay
NEXT = 0.25  # of a slew, which the cell behind it is slower by, about
GAIN_NS = 0.01  # least that a change is made for


@dataclass(frozen=True)
class Delays:
    """What a load costs on a path, by (cell, pin): the cell's delay, and what its slew costs the next cell."""

    curves: Mapping[End, Curve]

    @classmethod
    def of(cls, liberty: Group) -> "Delays":
        """Of a library (ns, pF): the mean of both edges, each by its worst arc."""
        curves = {(cell.name, pin.name): _curve(pin) for cell in liberty.all("cell") for pin in cell.all("pin")}
        return cls({end: curve for end, curve in curves.items() if curve})

    def ns(self, cell: str, pin: str, load: float) -> float:
        """Of ``load`` pF behind a pin."""
        loads, ns = self.curves[cell, pin]
        slope = (ns[-1] - ns[-2]) / (loads[-1] - loads[-2])
        return float(np.interp(load, loads, ns) + slope * max(0.0, load - loads[-1]))


def quickened(plan: Plan, drives: Drives, delays: Delays, kept: Collection[str], slacks: Slacks, enough: float) -> None:
    """Change what drives each net with less slack (ns) than ``enough`` where that gains.

    drives: limits of buffers that are inserted. kept: nets that stay as they are. The gain is estimated net by net,
    with what the cell before loses by a larger driver.
    """
    work = _Work(plan, drives, delays, connected(plan.instances))
    for net in list(work.nets):
        if net not in work.nets:
            continue  # of a buffer that was taken away
        driver, pin, sinks = work.nets[net]
        cell = plan.instances[driver].cell
        fixed = net in kept or net in plan.outside or not sinks or (cell, pin) not in delays.curves
        if fixed or slacks.get((driver, pin), enough) >= enough:
            continue
        load = work.load(net)
        inputs = ((driver, name) for name in plan.instances[driver].pins if (cell, name) in drives.inputs)
        late = [end for end in inputs if slacks.get(end, enough) < enough]
        choices: list[tuple[float, str | Sinks | None]] = []
        for form in drives.sizes[cell]:
            lost = max((work.lost(end, form) for end in late), default=0.0)
            choices.append((delays.ns(form, pin, load) + lost, form))
        first = min(slacks.get(end, np.inf) for end in sinks)
        waiting = [end for end in sinks if slacks.get(end, np.inf) >= first + BUFFER_NS]
        for group in (waiting, sinks) if waiting else (sinks,):
            choices.append((work.buffered(net, group), group))
        if driver.endswith(OWN):
            choices.append((work.merged(net), None))
        least, chosen = min(choices, key=lambda choice: choice[0])
        if least > delays.ns(cell, pin, load) - GAIN_NS:
            continue
        if chosen is None:
            work.remove(net)
        elif isinstance(chosen, str):
            swap(plan, driver, chosen)
        else:
            work.insert(net, chosen)


@dataclass(frozen=True)
class _Work:
    """A plan while its nets change. nets: as `connected` gives them, kept up to date."""

    plan: Plan
    drives: Drives
    delays: Delays
    nets: dict[str, tuple[str, str, Sinks]]

    def load(self, net: str) -> float:
        """Of a net, pF."""
        driver, _, sinks = self.nets[net]
        return self.plan.load(self.drives, net, [self.plan.point(driver)], sinks)

    def lost(self, end: End, larger: str) -> float:
        """How much slower (ns) the net of an input is if its cell is ``larger``."""
        cell, pins = self.plan.instances[end[0]].cell, self.plan.instances[end[0]].pins
        driver, output, _ = self.nets.get(pins[end[1]], ("", "", []))
        before = self.plan.instances[driver].cell if driver else ""
        if (before, output) not in self.delays.curves:
            return 0.0
        load, inputs = self.load(pins[end[1]]), self.drives.inputs
        more = inputs[larger, end[1]] - inputs[cell, end[1]]
        return self.delays.ns(before, output, load + more) - self.delays.ns(before, output, load)

    def buffered(self, net: str, group: Sinks) -> float:
        """The delay (ns) of a net to its sinks with a buffer before ``group``: to the others, if there are any."""
        (driver, pin, sinks), waiting, plan = self.nets[net], set(group), self.plan
        start, points = np.array(plan.point(driver)), np.array([plan.point(name) for name, _ in group])
        x, y = (float(value) for value in start + NEAR * (points.mean(axis=0) - start))
        load = plan.load(self.drives, "", [(x, y)], group)
        buffer = self.drives.best(BUFFER.cell, BUFFER.output, load)
        direct = [end for end in sinks if end not in waiting]
        before = plan.load(self.drives, net, [plan.point(driver), (x, y)], direct)
        first = self.delays.ns(plan.instances[driver].cell, pin, before + self.drives.inputs[buffer, BUFFER.input])
        return first if direct else first + self.delays.ns(buffer, BUFFER.output, load)

    def merged(self, net: str) -> float:
        """What a buffer's net would add (ns) to the one before it if that drove its sinks."""
        buffer, _, sinks = self.nets[net]
        above = self.plan.instances[buffer].pins[BUFFER.input]
        driver, pin, ends = self.nets.get(above, ("", "", []))
        cell = self.plan.instances[driver].cell if driver else ""
        if (cell, pin) not in self.delays.curves or above in self.plan.outside:
            return np.inf
        all_ends = [*(end for end in ends if end[0] != buffer), *sinks]
        load = self.plan.load(self.drives, above, [self.plan.point(driver)], all_ends)
        return self.delays.ns(cell, pin, load) - self.delays.ns(cell, pin, self.load(above))

    def insert(self, net: str, group: Sinks) -> None:
        """Put buffers before the sinks in ``group``."""
        before, (driver, pin, sinks) = self.plan.added, self.nets[net]
        split(self.plan, self.drives, net, driver, group)
        ends: dict[str, Sinks] = {net: []}
        for name, end in sinks:
            ends.setdefault(self.plan.instances[name].pins[end], []).append((name, end))
        for called in (f"{net}_{k}" for k in range(before, self.plan.added)):
            self.nets[called] = f"{called}{OWN}", BUFFER.output, ends[called]
            ends[net].append((f"{called}{OWN}", BUFFER.input))
        self.nets[net] = driver, pin, ends[net]

    def remove(self, net: str) -> None:
        """Take the buffer that drives a net away; what drives it drives its sinks."""
        name, _, sinks = self.nets.pop(net)
        buffer = self.plan.instances.pop(name)
        self.plan.rows.give(self.plan.widths[buffer.cell], self.plan.places.pop(name))
        above = buffer.pins[BUFFER.input]
        self.plan.connect(sinks, above)
        driver, pin, ends = self.nets[above]
        self.nets[above] = driver, pin, [*(end for end in ends if end[0] != name), *sinks]


def _curve(pin: Group) -> Curve | None:
    worst = [[_worst(pin, kind.format(edge)) for kind in ("cell_{}", "{}_transition")] for edge in ("rise", "fall")]
    found = [curve for edge in worst for curve in edge if curve]
    if len(found) < 4:
        return None
    loads = found[0][0]
    delay_rise, slew_rise, delay_fall, slew_fall = (np.interp(loads, *curve) for curve in found)
    return loads, (delay_rise + delay_fall + NEXT * (slew_rise + slew_fall)) / 2


def _worst(pin: Group, kind: str) -> Curve | None:
    """The largest values of the tables ``kind`` of a pin, over its loads."""
    curves = [over_loads(table, SLEW_NS) for arc in pin.all("timing") for table in arc.all(kind)]
    return (curves[0][0], np.max([ns for _, ns in curves], axis=0)) if curves else None
