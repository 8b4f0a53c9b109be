"""Rip-up and reroute of nets that are open, too near to others or have an antenna."""

import json
import re
from dataclasses import dataclass

import joblib

from base.gds import write_gds
from base.steps import Step
from models.parameters import check_int
from platforms.coriolis import coriolis_platform

from ..geometry import boxes as boxes_module
from ..netlist import netlist as netlist_module
from ..netlist.names import plain_names
from ..netlist.netlist import Netlist
from ..reroute import board as board_module
from ..reroute import negotiate as bargain_module
from ..reroute import nets, search, violations, window, wiring
from ..reroute.board import Board
from ..reroute.negotiate import bargain
from ..reroute.violations import Marks, marks, marks_of, shared_out
from ..reroute.wiring import Wiring
from . import antenna

JOBS = 2  # in which the router's layout is looked at
ROUNDS = 5  # who is moved for one net's sake may get an antenna by it


@dataclass(frozen=True)
class RerouteParameters:
    """pdk: process. clock: name of the clock port. most: nets, with more the layout is given up."""

    pdk: str = "sky130"
    clock: str = "clk"
    most: int = 60

    def __post_init__(self):
        check_int("most", self.most, 0, 10_000)


class Reroute(Step):
    """Rip-up and reroute with negotiated congestion.

    open_nets: still open. rerouted_nets: rerouted because they were open; antenna_jumpers: because of an antenna, with a
    jumper on the top layer in front of every gate; respaced_nets: because another net was too near; evicted_nets:
    because they were in the way. The clock tree is left alone, except the net from the port to its root.
    """

    name = "reroute"
    inputs = {
        "gds": "place_route.gds",
        "placement": "place_route.placement",
        "shapes": "place_route.shapes",
        "log": "place_route.log",
        "synthesized": "synthesis.netlist",
        "rules": "library.rules",
        "geometry": "library.geometry",
    }
    outputs = {"gds": "rerouted.gds", "placement": "placement.json"}
    Parameters = RerouteParameters
    metrics = {
        "open_nets": "",
        "rerouted_nets": "",
        "antenna_jumpers": "",
        "respaced_nets": "",
        "evicted_nets": "",
        "wire_um": "um",
    }
    uses = (
        antenna,
        bargain_module,
        boxes_module,
        board_module,
        violations,
        nets,
        search,
        window,
        wiring,
        netlist_module,
    )
    tools = ("python klayout",)

    def run(self, inputs, outputs):
        import klayout.db as db

        p, known = self.parameters, coriolis_platform(self.parameters.pdk)
        placement = json.loads(inputs["placement"].read_text())
        names = {plain: net for net, plain in plain_names(Netlist.read(inputs["synthesized"]), p.clock).items()}
        layout, left = db.Layout(), open_nets(inputs["log"].read_text())
        layout.read(str(inputs["gds"]))
        shapes = json.loads(inputs["shapes"].read_text())
        # Of a shape that two nets have drawn, the open one's is the short: it claims last
        order = [net for net in shapes if net in names and net not in left] + left
        rules = Wiring.of(known, json.loads(inputs["rules"].read_text()))
        board = Board(layout, rules, {net: shapes[net] for net in order})
        pins = {net: shapes[net]["pins"] for net in order}
        found, near, hopping = negotiated(board, pins, left, p.most, inputs["gds"], known)
        made = found.made if found else {}
        placement["wires"] |= {names.get(net, f"cts_{net}"): _wires(rules, shapes) for net, shapes in made.items()}
        write_gds(board.drawn(), outputs["gds"])
        outputs["placement"].write_text(json.dumps(placement, indent=0) + "\n")
        rerouted, jumped = set(made) & set(left), set(made) & hopping
        return {
            "open_nets": len(found.open if found else left),
            "rerouted_nets": len(rerouted),
            "antenna_jumpers": len(jumped - rerouted),
            "respaced_nets": len(near - rerouted - jumped),
            "evicted_nets": len(set(made) - rerouted - jumped - near),
            "wire_um": round(sum(wire[1] for net in placement["wires"].values() for wire in net), 1),
        }


def open_nets(log):
    """Names of the nets with a segment that the router gave up, by its own list: in order, each once."""
    return list(dict.fromkeys(re.findall(r"^\s+\d+\| &<id:\d+ (?:Horizontal|Vertical) (\S+) ", log, re.M)))


def negotiated(board, pins, left, most, gds, known):
    """(Bargain, nets too near to others, nets with antennas) of the ``board``; the Bargain is None where more than
    ``most`` nets are ``left`` open. The router's layout, the file ``gds``, is looked at in processes of their own while
    these are routed; later only what was made anew is, and what open nets had been shorts to."""
    close, charged = set(), set()
    if len(left) > most:
        return None, close, charged
    before, shorted = dict(board.there), board.beside(left)
    first = joblib.Parallel(n_jobs=JOBS, return_as="generator")(
        [joblib.delayed(marks_of)(gds, board.wiring, known, levels) for levels in shared_out(board.wiring, JOBS)]
    )
    found = bargain(board, pins, left)
    rest = [net for net in board.nets if net not in {*found.made, *shorted}]
    asked = sum(first, Marks((), ())).nets(board, before, rest)
    for _ in range(ROUNDS):
        looked_at = {*found.made, *shorted}
        fresh = marks(board.part(looked_at), board.wiring, known).nets(board, board.there, looked_at)
        close, charged = close.union(asked[0], fresh[0]), charged.union(asked[1], fresh[1])
        wanted = sorted({*asked[0], *asked[1], *fresh[0], *fresh[1]})
        if found.open or not wanted or len(wanted) > most:
            break
        bargain(board, pins, wanted, charged, found)
        asked = (), ()
    return found, close, charged


def _wires(rules, shapes):
    """[[layer, length_um, width_um], ...] of a net, a cut with length 0: what the extraction reads."""
    made = [
        [rules.layers[level].name, nm / 1000, rules.layers[level].width / 1000] for level, nm in shapes.lengths.items()
    ]
    return made + [
        ["_".join((rules.layers[level].name, rules.cuts[level].name, rules.layers[level + 1].name)), 0, 0]
        for level, middles in shapes.cuts.items()
        for _ in middles
    ]
