"""Nets that the router left open, taken out of the layout and routed anew by a search; without one, the layout as is."""

import json
import re
from dataclasses import dataclass

from flow.platforms.embedded import process
from flow.steps import Step
from models.parameters import check_int

from .. import netlist as netlist_module
from ..mend import nets, search, window, wiring
from ..mend.wiring import Wiring
from ..netlist import Netlist
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
    """open_nets: left open, every one that was where a net could not be routed. mended: nets routed anew."""

    name = "mend"
    inputs = {"gds": "place_route.gds", "placement": "place_route.placement", "shapes": "place_route.shapes",
              "log": "place_route.log", "synthesized": "synthesis.netlist", "rules": "library.rules",
              "geometry": "library.geometry"}
    outputs = {"gds": "mended.gds", "placement": "placement.json"}
    Parameters = MendParameters
    metrics = {"open_nets": "", "mended": "", "wire_um": "um"}
    uses = (nets, search, window, wiring, netlist_module)
    tools = ("python klayout",)

    def run(self, inputs, outputs):
        import klayout.db as db
        p, (known, _) = self.parameters, process(self.parameters.pdk)
        placement = json.loads(inputs["placement"].read_text())
        names = {plain: net for net, plain in plain_names(Netlist.read(inputs["synthesized"]), p.clock).items()}
        layout, left = db.Layout(), open_nets(inputs["log"].read_text())
        layout.read(str(inputs["gds"]))
        made = {}
        if 0 < len(left) <= p.most:
            rules = Wiring.of(known, json.loads(inputs["rules"].read_text()))
            shapes = json.loads(inputs["shapes"].read_text())
            made = mended(layout, rules, {net: shapes[net] for net in left}) or {}
        for net, wires in made.items():
            placement["wires"][names.get(net, f"cts_{net}")] = wires
        layout.write(str(outputs["gds"]))
        outputs["placement"].write_text(json.dumps(placement, indent=0) + "\n")
        return {"open_nets": len(left) - len(made), "mended": len(made),
                "wire_um": round(sum(wire[1] for net in placement["wires"].values() for wire in net), 1)}


def open_nets(log):
    """Names of the nets with a segment that the router gave up, by its own list: in order, each once."""
    return list(dict.fromkeys(re.findall(r"^\s+\d+\| &<id:\d+ (?:Horizontal|Vertical) (\S+) ", log, re.M)))


def mended(layout, rules, found):
    """Take the nets ``found`` (dict net -> its shapes, as coriolis.dump has them) out of the layout's top cell and put
    them in anew: dict net -> its wires as in placement.json. None, and the layout as it was, if one has no way."""
    top = layout.top_cell()
    before = top.dup()
    for made in found.values():
        take_out(layout, top, rules, made)
    wires, level = {}, {layer.name: k for k, layer in enumerate(rules.layers)}
    for net, made in sorted(found.items(), key=lambda item: _span(item[1])):
        pins = [[(level[name], *_nm(box)) for name, *box in pin] for pin in made["pins"]]
        shapes = nets.routed(layout, top, rules, pins)
        if shapes is None:
            name = top.name
            layout.delete_cell(top.cell_index())
            before.name = name
            return None
        put_in(layout, top, rules, shapes)
        wires[net] = _wires(rules, shapes)
    layout.delete_cell(before.cell_index())
    return wires


def take_out(layout, top, rules, made):
    """Erase the wires and cuts of one net from ``top``."""
    boxes, middles = {}, {}
    for name, *box in made["wires"]:
        left, bottom, right, high = _nm(box)
        if left == right or bottom == high:      # drawn as a pad
            middles.setdefault(name, set()).add(((left + right) // 2, (bottom + high) // 2))
        else:
            boxes.setdefault(name, set()).add((left, bottom, right, high))
    for name, x, y in made["cuts"]:
        for part in name.split("_"):
            middles.setdefault(part, set()).add(_nm((x, y)))
    for layer in (*rules.layers, *rules.cuts):
        shapes = top.shapes(layout.layer(layer.layer, layer.datatype))
        where, at = boxes.get(layer.name, set()), middles.get(layer.name, set())
        for shape in [shape for shape in shapes.each() if not shape.is_text()]:
            box = shape.bbox()
            if (box.left, box.bottom, box.right, box.top) in where or (box.center().x, box.center().y) in at:
                shape.delete()


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
