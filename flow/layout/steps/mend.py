"""Nets that the router left open, too near to others or with an antenna, routed anew."""

import json
import re
from dataclasses import dataclass

from flow.gds import write_gds
from flow.platforms.embedded import process
from flow.steps import Step
from models.parameters import check_int

from .. import boxes as boxes_module
from .. import netlist as netlist_module
from ..mend import bargain as bargain_module
from ..mend import board as board_module
from ..mend import nets, search, window, wiring
from ..mend.bargain import bargain
from ..mend.board import Board, crowded
from ..mend.wiring import Wiring
from ..netlist import Netlist
from . import antenna
from .antenna import violations
from .place_route import plain_names

ROUNDS = 5          # who is moved for one net's sake may get an antenna by it


@dataclass(frozen=True)
class MendParameters:
    """pdk: process. clock: name of the clock port. most: nets, with more the layout is given up."""

    pdk: str = "sky130"
    clock: str = "clk"
    most: int = 60

    def __post_init__(self):
        check_int("most", self.most, 0, 10_000)


class Mend(Step):
    """open_nets: left open. mended: nets routed anew because they were open, hopped: because of an antenna, each gate
    behind a piece of the highest wire, parted: because another was nearer than the rules allow, moved: because they
    were in the way. Wires of the clock's tree are left alone, but for the one from the port to its root."""

    name = "mend"
    inputs = {"gds": "place_route.gds", "placement": "place_route.placement", "shapes": "place_route.shapes",
              "log": "place_route.log", "synthesized": "synthesis.netlist", "rules": "library.rules",
              "geometry": "library.geometry"}
    outputs = {"gds": "mended.gds", "placement": "placement.json"}
    Parameters = MendParameters
    metrics = {"open_nets": "", "mended": "", "hopped": "", "parted": "", "moved": "", "wire_um": "um"}
    uses = (antenna, bargain_module, boxes_module, board_module, nets, search, window, wiring, netlist_module)
    tools = ("python klayout",)

    def run(self, inputs, outputs):
        import klayout.db as db
        p, (known, _) = self.parameters, process(self.parameters.pdk)
        placement = json.loads(inputs["placement"].read_text())
        names = {plain: net for net, plain in plain_names(Netlist.read(inputs["synthesized"]), p.clock).items()}
        layout, left = db.Layout(), open_nets(inputs["log"].read_text())
        layout.read(str(inputs["gds"]))
        shapes = json.loads(inputs["shapes"].read_text())
        # Of a shape that two nets have drawn, the open one's is the short: it claims last
        order = [net for net in shapes if net in names and net not in left] + left
        board = Board(layout, Wiring.of(known, json.loads(inputs["rules"].read_text())),
                      {net: shapes[net] for net in order})
        pins, hopping = {net: shapes[net]["pins"] for net in order}, set()
        found = bargain(board, pins, left) if len(left) <= p.most else None
        near, looked_at = set(), None           # at all nets the first time
        for _ in range(ROUNDS if found else 0):
            close, charged = crowded(board), antennas(board, known, looked_at)
            asked = sorted({*close, *charged})
            if found.open or not asked or len(asked) > p.most:
                break
            near |= set(close)
            hopping |= set(charged)
            bargain(board, pins, asked, hopping, found)
            looked_at = found.made
        made = found.made if found else {}
        placement["wires"] |= {names.get(net, f"cts_{net}"): _wires(board.wiring, shapes)
                               for net, shapes in made.items()}
        write_gds(board.drawn(), outputs["gds"])
        outputs["placement"].write_text(json.dumps(placement, indent=0) + "\n")
        mended, hopped = set(made) & set(left), set(made) & hopping
        return {"open_nets": len(found.open if found else left), "mended": len(mended), "hopped": len(hopped - mended),
                "parted": len(near - mended - hopped), "moved": len(set(made) - mended - hopped - near),
                "wire_um": round(sum(wire[1] for net in placement["wires"].values() for wire in net), 1)}


def open_nets(log):
    """Names of the nets with a segment that the router gave up, by its own list: in order, each once."""
    return list(dict.fromkeys(re.findall(r"^\s+\d+\| &<id:\d+ (?:Horizontal|Vertical) (\S+) ", log, re.M)))


def antennas(board, known, looked_at=None):
    """Names of the nets on the ``board``, of ``looked_at`` or all, on which a wire is too large for its gates."""
    layout = board.drawn(looked_at)
    found = violations(layout, layout.top_cell(), known)
    return sorted(set().union(*(board.at(level, bad.each()) for level, bad in enumerate(found))))


def _wires(rules, shapes):
    """[[layer, length_um, width_um], ...] of a net, a cut with length 0: what the extraction reads."""
    made = [[rules.layers[level].name, nm / 1000, rules.layers[level].width / 1000]
            for level, nm in shapes.lengths.items()]
    return made + [["_".join((rules.layers[level].name, rules.cuts[level].name, rules.layers[level + 1].name)), 0, 0]
                   for level, middles in shapes.cuts.items() for _ in middles]

