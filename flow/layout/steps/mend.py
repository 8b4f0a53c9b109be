"""Nets that the router left open or with an antenna, taken out of the layout and routed anew by a search."""

import json
import re
from dataclasses import dataclass

from flow.gds import write_gds
from flow.platforms.embedded import process
from flow.steps import Step
from models.parameters import check_int

from .. import netlist as netlist_module
from ..mend import nets, search, window, wiring
from ..mend.wiring import Wiring
from ..netlist import Netlist
from . import antenna
from .antenna import violations
from .place_route import plain_names


@dataclass(frozen=True)
class MendParameters:
    """pdk: process. clock: name of the clock port. most: nets, with more the layout is given up."""

    pdk: str = "sky130"
    clock: str = "clk"
    most: int = 60

    def __post_init__(self):
        check_int("most", self.most, 0, 10_000)


class Mend(Step):
    """open_nets: left open, every one that was where a net could not be routed. mended: nets routed

    anew. hopped: nets with an antenna routed anew, each gate behind a piece of the highest wire."""

    name = "mend"
    inputs = {"gds": "place_route.gds", "placement": "place_route.placement", "shapes": "place_route.shapes",
              "log": "place_route.log", "synthesized": "synthesis.netlist", "rules": "library.rules",
              "geometry": "library.geometry"}
    outputs = {"gds": "mended.gds", "placement": "placement.json"}
    Parameters = MendParameters
    metrics = {"open_nets": "", "mended": "", "hopped": "", "wire_um": "um"}
    uses = (antenna, nets, search, window, wiring, netlist_module)
    tools = ("python klayout",)

    def run(self, inputs, outputs):
        import klayout.db as db
        p, (known, _) = self.parameters, process(self.parameters.pdk)
        placement = json.loads(inputs["placement"].read_text())
        names = {plain: net for net, plain in plain_names(Netlist.read(inputs["synthesized"]), p.clock).items()}
        layout, left = db.Layout(), open_nets(inputs["log"].read_text())
        layout.read(str(inputs["gds"]))
        rules = Wiring.of(known, json.loads(inputs["rules"].read_text()))
        shapes = json.loads(inputs["shapes"].read_text())
        made = again(layout, rules, {net: shapes[net] for net in left}) if len(left) <= p.most else {}
        hopped = {}
        if len(made) == len(left):
            charged = {net: shapes[net] for net in antennas(layout, known, shapes) if net not in made}
            hopped = again(layout, rules, charged, hops=True) if len(charged) <= p.most else {}
        for net, wires in (made | hopped).items():
            placement["wires"][names.get(net, f"cts_{net}")] = wires
        write_gds(layout, outputs["gds"])
        outputs["placement"].write_text(json.dumps(placement, indent=0) + "\n")
        return {"open_nets": len(left) - len(made), "mended": len(made), "hopped": len(hopped),
                "wire_um": round(sum(wire[1] for net in placement["wires"].values() for wire in net), 1)}


def open_nets(log):
    """Names of the nets with a segment that the router gave up, by its own list: in order, each once."""
    return list(dict.fromkeys(re.findall(r"^\s+\d+\| &<id:\d+ (?:Horizontal|Vertical) (\S+) ", log, re.M)))


def antennas(layout, known, shapes):
    """Names of the nets, of ``shapes``, on which a wire is too large for its gates."""
    import klayout.db as db
    middles = {}
    for net, made in shapes.items():
        for name, *box in made["wires"]:
            middles.setdefault(name, []).append((*_middle(_nm(box)), net))
    found = set()
    for level, wire in enumerate(known.wires):
        for polygon in violations(layout, layout.top_cell(), known, level).each():
            box = polygon.bbox()
            found |= {net for x, y, net in middles.get(wire.name, ()) if box.left <= x <= box.right
                      and box.bottom <= y <= box.top and polygon.inside(db.Point(x, y))}
    return sorted(found)


def again(layout, rules, found, hops=False):
    """Take the nets ``found`` (dict net -> its shapes, as coriolis.dump has them) out of the layout's top cell and put
    them in anew, small ones first: dict net -> its wires as in placement.json, of those that there was a way for. What
    had none is as it was, shorts of an open net included."""
    top, wires = layout.top_cell(), {}
    levels = {layer.name: k for k, layer in enumerate(rules.layers)}
    erased = {net: take_out(layout, top, rules, made) for net, made in found.items()}
    for net, made in sorted(found.items(), key=lambda item: _span(item[1])):
        pins = [[(levels[name], *_nm(box)) for name, *box in pin] for pin in made["pins"]]
        shapes = nets.routed(layout, top, rules, pins, hops)
        if shapes:
            put_in(layout, top, rules, shapes)
            wires[net] = _wires(rules, shapes)
        else:
            for layer, polygon in erased[net]:
                top.shapes(layer).insert(polygon)
    return wires


def take_out(layout, top, rules, made):
    """Erase the wires and cuts of one net from ``top``: list of (layer, polygon) that lay there."""
    import klayout.db as db
    wanted = [(name, _nm(box)) for name, *box in made["wires"]]
    wanted += [(name, (x, y, x, y)) for name, box in wanted for x, y in _ends(*box)]       # where wires meet lie pads
    wanted += [(part, 2 * _nm((x, y))) for name, x, y in made["cuts"] for part in name.split("_")]
    ports, erased = {_nm(box) for pin in made["pins"] for _, *box in pin}, []
    layers = {layer.name: layout.layer(layer.layer, layer.datatype) for layer in (*rules.layers, *rules.cuts)}
    for name, box in wanted:
        shapes = top.shapes(layers[name])
        for shape in list(shapes.each_touching(db.Box(*box))):
            there = shape.bbox()
            ends = there.left, there.bottom, there.right, there.top
            if not shape.is_text() and ends not in ports and (ends == box or 2 * _middle(ends) == box):
                erased.append((layers[name], shape.polygon))
                shape.delete()
    return erased


def _middle(box):
    return (box[0] + box[2]) // 2, (box[1] + box[3]) // 2


def _ends(left, bottom, right, top):
    """Middles of the two ends of a wire."""
    x, y = _middle((left, bottom, right, top))
    return ((left, y), (right, y)) if right - left > top - bottom else ((x, bottom), (x, top))


def put_in(layout, top, rules, shapes):
    """Draw the Shapes of a net."""
    import klayout.db as db
    for level, boxes in shapes.wires.items():
        layer = rules.layers[level]
        top.shapes(layout.layer(layer.layer, layer.datatype)).insert(
            db.Region([db.Box(*box) for box in boxes]).merged())
    for level, middles in shapes.cuts.items():
        cut = rules.cuts[level]
        for x, y in set(middles):
            half = cut.size // 2
            top.shapes(layout.layer(cut.layer, cut.datatype)).insert(db.Box(x - half, y - half, x + half, y + half))


def _wires(rules, shapes):
    """[[layer, length_um, width_um], ...] of a net, a cut with length 0: what the extraction reads."""
    made = [[rules.layers[level].name, nm / 1000, rules.layers[level].width / 1000]
            for level, nm in shapes.lengths.items()]
    return made + [["_".join((rules.layers[level].name, rules.cuts[level].name, rules.layers[level + 1].name)), 0, 0]
                   for level, middles in shapes.cuts.items() for _ in middles]


def _span(made):
    """um, half the girth of the box around a net's pins."""
    boxes = [box for pin in made["pins"] for box in pin]
    return max(b[3] for b in boxes) - min(b[1] for b in boxes) + max(b[4] for b in boxes) - min(b[2] for b in boxes)


def _nm(values):
    return tuple(round(1000 * value) for value in values)
