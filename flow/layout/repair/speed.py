"""Late paths made faster net by net: a larger driver, a buffer for the sinks that can wait, a buffer for all."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from talbot.base.liberty.group import Group

from .drive import Drives
from .repair import BUFFER, BUFFER_NS, NEAR, OWN, End, Plan, Sinks, Slacks, connected, split, swap

SLEW_NS = 0.2  # of the input, for a cell's delay
NEXT = 0.25  # of a slew, which the cell behind it is slower by, about
GAIN_NS = 0.01  # least that a change is made for
Nets = dict[str, tuple[str, str, Sinks]]  # as `connected` gives them
Curve = tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]  # loads (pF), ns


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
    nets = connected(plan.instances)
    for net in list(nets):
        if net not in nets:
            continue  # of a buffer that was taken away
        driver, pin, sinks = nets[net]
        cell, at = plan.instances[driver].cell, plan.point(driver)
        fixed = net in kept or net in plan.outside or not sinks or (cell, pin) not in delays.curves
        if fixed or slacks.get((driver, pin), enough) >= enough:
            continue
        load = plan.load(drives, net, [at], sinks)
        now = delays.ns(cell, pin, load)
        late = [(driver, name) for name in plan.instances[driver].pins if slacks.get((driver, name), enough) < enough]
        losses = {form: [_lost(plan, drives, delays, nets, end, form) for end in late] for form in drives.sizes[cell]}
        choices = [(delays.ns(form, pin, load) + max(lost, default=0.0), form) for form, lost in losses.items()]
        first = min(slacks.get(end, np.inf) for end in sinks)
        waiting = [end for end in sinks if slacks.get(end, np.inf) >= first + BUFFER_NS]
        for group in (waiting, sinks) if waiting else (sinks,):
            choices.append((_buffered(plan, drives, delays, net, nets[net], group), group))
        if driver.endswith(OWN):
            choices.append((_merged(plan, drives, delays, nets, net), None))
        least, chosen = min(choices, key=lambda choice: choice[0])
        if least > now - GAIN_NS:
            continue
        if chosen is None:
            _remove(plan, nets, net)
        elif isinstance(chosen, str):
            swap(plan, driver, chosen)
        else:
            _insert(plan, drives, nets, net, chosen)


def _insert(plan: Plan, drives: Drives, nets: Nets, net: str, group: Sinks) -> None:
    """Put buffers before the sinks in ``group``."""
    before, (driver, pin, sinks) = plan.added, nets[net]
    split(plan, drives, net, driver, group)
    made = [f"{net}_{k}" for k in range(before, plan.added)]
    for called in (net, *made):
        ends = [(name, end) for name, end in sinks if plan.instances[name].pins[end] == called]
        nets[called] = (driver, pin, ends) if called == net else (f"{called}{OWN}", BUFFER.output, ends)
    nets[net][2].extend((f"{called}{OWN}", BUFFER.input) for called in made)


def _remove(plan: Plan, nets: Nets, net: str) -> None:
    """Take the buffer that drives a net away; what drives it drives its sinks."""
    name, _, sinks = nets.pop(net)
    buffer = plan.instances.pop(name)
    plan.rows.give(plan.widths[buffer.cell], plan.places.pop(name))
    above = buffer.pins[BUFFER.input]
    for owner, pin in sinks:
        plan.instances[owner] = replace(plan.instances[owner], pins=plan.instances[owner].pins | {pin: above})
    nets[above][2].remove((name, BUFFER.input))
    nets[above][2].extend(sinks)


def _buffered(
    plan: Plan, drives: Drives, delays: Delays, net: str, ends: tuple[str, str, Sinks], group: Sinks
) -> float:
    """The delay (ns) to all sinks with a buffer before all, in ``group``; to the others where it is not all."""
    driver, pin, sinks = ends
    start, points = plan.point(driver), np.array([plan.point(name) for name, _ in group])
    x, y = np.array(start) + NEAR * (points.mean(axis=0) - start)
    load, waiting = plan.load(drives, "", [(float(x), float(y))], group), set(group)
    buffer = drives.best(BUFFER.cell, BUFFER.output, load)
    direct = [end for end in sinks if end not in waiting]
    before = plan.load(drives, net, [start, (float(x), float(y))], direct) + drives.inputs[buffer, BUFFER.input]
    return delays.ns(plan.instances[driver].cell, pin, before) + (
        0.0 if direct else delays.ns(buffer, BUFFER.output, load)
    )


def _merged(plan: Plan, drives: Drives, delays: Delays, nets: Nets, net: str) -> float:
    """What the net of a buffer would add (ns) to the one before it if that drove its sinks."""
    buffer, _, sinks = nets[net]
    above = plan.instances[buffer].pins[BUFFER.input]
    name, pin, ends = nets.get(above, ("", "", []))
    if name not in plan.instances or (plan.instances[name].cell, pin) not in delays.curves or above in plan.outside:
        return np.inf
    rest = [end for end in ends if end[0] != buffer]
    now, then = (plan.load(drives, above, [plan.point(name)], found) for found in (ends, [*rest, *sinks]))
    cell = plan.instances[name].cell
    return delays.ns(cell, pin, then) - delays.ns(cell, pin, now)


def _lost(plan: Plan, drives: Drives, delays: Delays, nets: Nets, end: End, larger: str) -> float:
    """How much slower (ns) the net of an input is if its cell is ``larger``."""
    name, pin = end
    instance = plan.instances[name]
    driver, output, sinks = nets.get(instance.pins[pin], ("", "", []))
    cell = plan.instances[driver].cell if driver else ""
    if (cell, output) not in delays.curves or (instance.cell, pin) not in drives.inputs:
        return 0.0
    load = plan.load(drives, instance.pins[pin], [plan.point(driver)], sinks)
    more = drives.inputs[larger, pin] - drives.inputs[instance.cell, pin]
    return delays.ns(cell, output, load + more) - delays.ns(cell, output, load)


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
    curves = []
    for table in (table for arc in pin.all("timing") for table in arc.all(kind)):
        slews, loads = table.array("index_1"), table.array("index_2")
        curves.append((loads, np.array([np.interp(SLEW_NS, slews, column) for column in table.array("values").T])))
    return (curves[0][0], np.max([ns for _, ns in curves], axis=0)) if curves else None
