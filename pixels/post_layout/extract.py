"""A drawn cell as a circuit with its parasitics: transistors with drawn junctions, resistors, capacitors.

Every net is a tree of resistors (signoff/parasitics) from its pin, or from a transistor, to the straps of all its
transistors and the taps of its capacitors. Of its capacitance the part to the substrate is spread over the tree as its
metal is; what couples to another net is between the middles of both. The capacitors' upper plates are one node each: a
mesh of some ohms. Metal over an upper plate does not couple to the lower one: that is the capacitor. Of a bank of
fringe capacitors the rays give the ratios; all units together are as many of the circuit's.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from types import ModuleType
from typing import Any

import numpy as np

from talbot.base.gds import db
from talbot.base.steps import StepError
from talbot.pixels.analog_layout.cells import Cell
from talbot.pixels.circuits.netlist import Capacitor, Circuit, Resistor
from talbot.platforms.analog import AnalogMasks
from talbot.platforms.extraction import extraction_platform
from talbot.platforms.layout import layout_platform
from talbot.platforms.wires import Wires
from talbot.signoff.parasitics.capacitance import capacitances
from talbot.signoff.parasitics.shapes import METAL_LEVEL, Shapes, labels, shapes
from talbot.signoff.parasitics.trees import trees

SUBSTRATE = "vss"
LEAST_FARAD = 1e-18  # coupling below it counts as to the substrate
LEAST_OHM = 0.5  # nodes with less between them are one
FIRST, THIRD = METAL_LEVEL + 1, METAL_LEVEL + 3  # levels of the straps and of the taps


@dataclass(frozen=True)
class Extracted(Circuit):
    """A circuit of transistors in fingers. drawn: (fingers, um2 of source and drain, um around them) by name."""

    drawn: Mapping[str, tuple[int, float, float, float, float]] = field(default_factory=dict)

    def own_sizes(self) -> set[tuple[str, float, float]]:
        """(role, w of a finger, l) of every transistor."""
        return {(t.role, round(t.w / self.drawn[t.name][0], 6), t.l) for t in self.transistors}

    def devices(self, process: ModuleType) -> list[str]:
        """Lines of its transistors, each as its fingers in parallel."""
        text = []
        for t in self.transistors:
            fingers, *junctions = self.drawn[t.name]
            each = tuple(one / fingers for one in junctions)
            text.append(process.finger(t.name, t.nodes, t.role, t.w / fingers, t.l, fingers, each))
        return text


@dataclass(frozen=True)
class Nets:
    """The nets of a layout by name. totals, grounds: F of each, all and to the substrate. couplings: F of pairs."""

    totals: dict[str, float]
    grounds: dict[str, float]
    couplings: dict[tuple[str, str], float]


@dataclass(frozen=True)
class _Pin:
    net: str
    what: tuple[str, str]
    level: int
    x: float
    y: float


def extract(made: Cell, masks: AnalogMasks, wires: Wires, resistance: bool = True) -> tuple[Extracted, Nets]:
    """The circuit of a drawn cell with its parasitics, and these by net. Raises StepError where a net is in pieces."""
    pdk = masks.base.name
    tech, platform = layout_platform(pdk), extraction_platform(pdk)
    whole, cut = _layouts(made, masks)
    found = shapes(whole, whole.top_cell(), tech, platform)
    pins = list(_pins(made))
    named = labels(whole, whole.top_cell(), tech)
    ports = [_Pin(net, ("", net), *_um(named[net][0], whole.dbu)) for net in made.ports]
    pins = [*ports, *pins]
    boxes = [found.at(pin.level, round(pin.x / whole.dbu), round(pin.y / whole.dbu)) for pin in pins]
    if lost := [pin.what for pin, box in zip(pins, boxes, strict=True) if box < 0]:
        raise StepError(f"extraction: {lost[0]} is not on its metal")
    names = _names(found, pins, boxes)
    nets = _nets(shapes(cut, cut.top_cell(), tech, platform), found, names, wires)
    order = sorted(range(len(pins)), key=lambda k: (found.nets[boxes[k]], k))
    pins, boxes = [pins[k] for k in order], [boxes[k] for k in order]
    roots = [k for k, box in enumerate(boxes) if not k or found.nets[box] != found.nets[boxes[k - 1]]]
    points = [(box, round(pin.x / whole.dbu), round(pin.y / whole.dbu)) for pin, box in zip(pins, boxes, strict=True)]
    vias = [platform.vias[0].lef, *(via.lef for via in tech.vias)]
    own = capacitances(found, [wires])[0].own
    made_trees = trees(found, own, wires, vias, points, roots)
    return _circuit(made, pins, made_trees, nets, resistance), nets


def unit_farad(made: Cell, nets: Nets) -> float:
    """Return the mean capacitance of a fringe unit by the rays, F; 0 without any. Raises StepError."""
    if lost := [pair for pair in made.matched if pair not in nets.couplings]:
        raise StepError(f"extraction: nets {' and '.join(lost[0])} must have a capacitor between them")
    return sum(nets.couplings[pair] for pair in made.matched) / max(1, sum(made.matched.values()))


def _um(at: tuple[int, int, int], dbu: float) -> tuple[int, float, float]:
    return at[0], at[1] * dbu, at[2] * dbu


def _layouts(made: Cell, masks: AnalogMasks) -> tuple["db.Layout", "db.Layout"]:
    """Return the cell without vias on upper plates and resistors' bodies, and without the metal over plates, too."""
    whole = db.Layout()
    whole.assign(made.layout)
    top = whole.top_cell()
    top.flatten(True)
    plates = db.Region(top.shapes(whole.layer(*masks.mim))).merged()
    via = whole.layer(*masks.base.vias[masks.mim_metal].gds)
    rest = db.Region(top.shapes(via)) - plates
    top.clear(via)
    top.shapes(via).insert(rest)
    active = whole.layer(*masks.base.active)
    bodies = db.Region(top.shapes(whole.layer(*masks.resistor))).merged()
    ends = db.Region(top.shapes(active)) - bodies
    top.clear(active)
    top.shapes(active).insert(ends)
    cut = db.Layout()
    cut.assign(whole)
    metal = cut.layer(*masks.base.metals[masks.mim_metal + 1].gds)
    left = db.Region(cut.top_cell().shapes(metal)) - plates
    cut.top_cell().clear(metal)
    cut.top_cell().shapes(metal).insert(left)
    return whole, cut


def _pins(made: Cell) -> Iterator[_Pin]:
    """Ends of transistors on the first metal, taps of capacitors on the third."""
    for device, strap in made.terminals:
        yield _Pin(strap.net, (device, strap.end), FIRST, (strap.left + strap.right) / 2, strap.y)
    lower = {plate.name: plate.lower for plate in made.plates}
    for k, (name, _, x, y) in enumerate(made.taps):
        yield _Pin(lower[name], (name, str(k)), THIRD, x, y)
    own = {r.name: r for r in made.resistors}
    for name, *places in made.ends:
        for net, (x, y) in zip((own[name].a, own[name].b), places, strict=True):
            yield _Pin(net, (name, net), FIRST, x, y)


def _names(found: Shapes, pins: list[_Pin], boxes: list[int]) -> dict[int, str]:
    """Names of the layout's nets. Raises StepError where one name is on two nets, or two are on one."""
    names: dict[int, str] = {}
    numbers: dict[str, int] = {}
    for pin, box in zip(pins, boxes, strict=True):
        net = int(found.nets[box])
        if names.setdefault(net, pin.net) != pin.net or numbers.setdefault(pin.net, net) != net:
            raise StepError(f"extraction: net {pin.net} must be one piece of metal, at {pin.what} it is {names[net]}")
    return names


def _nets(cut: Shapes, found: Shapes, names: Mapping[int, str], wires: Wires) -> Nets:
    """Capacitances by net. cut: the layout without metal over upper plates; found: with it, which knows the nets."""
    middles = (cut.boxes[:, :2] + cut.boxes[:, 2:]) // 2
    places = zip(cut.levels.tolist(), middles.tolist(), strict=True)
    numbers = [found.nets[found.at(level, x, y)] for level, (x, y) in places]
    joined = Shapes(cut.dbu, cut.names, cut.boxes, cut.levels, np.array(numbers, np.int32), cut.links, cut.bins)
    result = capacitances(joined, [wires])[0]
    totals: dict[str, float] = {}
    grounds: dict[str, float] = {}
    couplings: dict[tuple[str, str], float] = {}
    for (a, b), femtofarad in zip(result.pairs.tolist(), result.coupling.tolist(), strict=True):
        one, two = names.get(a, SUBSTRATE), names.get(b, SUBSTRATE)
        farad = femtofarad * 1e-15
        for net in {one, two}:
            totals[net] = totals.get(net, 0.0) + farad
        if SUBSTRATE in (one, two) or farad < LEAST_FARAD:
            for net in {one, two}:
                grounds[net] = grounds.get(net, 0.0) + farad
        else:
            key = (min(one, two), max(one, two))
            couplings[key] = couplings.get(key, 0.0) + farad
    return Nets(totals, grounds, couplings)


def _circuit(made: Cell, pins: list[_Pin], grown: Any, nets: Nets, resistance: bool) -> Extracted:
    """Return the netlist of the trees; without ``resistance`` every net is one node."""
    kept = np.flatnonzero(grown.kept)
    root: dict[int, int] = {}
    own: dict[int, list[int]] = {}
    for node in kept[np.argsort(grown.distance[kept], kind="stable")].tolist():
        parent = int(grown.parents[node])
        root[node] = root[parent] if parent >= 0 else node
        own.setdefault(root[node], []).append(node)
    of = {root[int(node)]: pin.net for node, pin in zip(grown.pins, pins, strict=True)}
    called, capacitors, resistors, middle = dict[int, str](), list[Capacitor](), list[Resistor](), dict[str, str]()
    for first, net in of.items():
        nodes = own[first]
        weights = grown.femtofarad[nodes]
        for k, node in enumerate(nodes):
            parent = int(grown.parents[node])
            joined = parent >= 0 and (not resistance or grown.ohm[node] < LEAST_OHM)
            called[node] = net if not k else called[parent] if joined else f"{net}__{k}"
        middle[net] = called[nodes[int(np.argmax(weights))]]
        share = weights / weights.sum() if weights.sum() else np.full(len(nodes), 1 / len(nodes))
        for node, part in zip(nodes, share.tolist(), strict=True):
            farad = part * nets.grounds.get(net, 0.0)
            if net != SUBSTRATE and farad >= LEAST_FARAD:
                capacitors.append(Capacitor(f"g{len(capacitors)}", called[node], SUBSTRATE, farad))
            parent = int(grown.parents[node])
            if parent >= 0 and called[parent] != called[node]:
                resistors.append(Resistor(f"w{len(resistors)}", called[parent], called[node], float(grown.ohm[node])))
    at = {pin.what: called[int(node)] for node, pin in zip(grown.pins, pins, strict=True)}
    own_unit = unit_farad(made, nets)
    for (a, b), farad in nets.couplings.items():
        count = made.matched.get((a, b), 0)
        value = farad / own_unit * made.unit if count else farad
        capacitors.append(Capacitor(f"x{len(capacitors)}", middle.get(a, a), middle.get(b, b), value, count))
    upper = {plate.name: plate for plate in made.plates}
    units: dict[str, float] = {}
    for name, count, _, _ in made.taps:
        units[name] = units.get(name, 0.0) + count
    for k, (name, count, _, _) in enumerate(made.taps):
        plate = upper[name]
        farad = count / units[name] * 1e-15 * (2.0 * plate.area + 0.19 * plate.edge)
        common = middle[plate.upper]
        capacitors.append(Capacitor(f"p{k}_{name}", common, at[name, str(k)], farad, max(1, round(count))))
    resistors += [r._replace(a=at[r.name, r.a], b=at[r.name, r.b]) for r in made.resistors]
    ends = {device.transistor.name: device for device in made.devices}
    placed = []
    drawn: dict[str, tuple[int, float, float, float, float]] = {}
    for name, device in ends.items():
        t = device.transistor
        drain, gate, source = (at.get((name, end), net) for end, net in zip("dgs", t.nodes, strict=False))
        placed.append(t._replace(drain=drain, gate=gate, source=source))
        drawn[name] = (device.fingers, *device.junctions_um)
        for off in device.off:
            inner = at.get((name, "s"), t.source) if device.fingers > 1 or off.drain == t.source else at[name, "d"]
            placed.append(off._replace(drain=inner))
            half, w = off.w * 0.14, off.w
            drawn[off.name] = 1, w * 0.265, half, w + 2 * 0.265, 2 * 0.14
    return Extracted(made.cell.name, made.ports, tuple(placed), tuple(capacitors), tuple(resistors), drawn=drawn)
