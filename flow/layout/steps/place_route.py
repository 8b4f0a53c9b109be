"""Power, placement, clock tree and routing: Coriolis, in a process of its own."""

import json
import re
import sys
import tempfile
from collections import Counter
from dataclasses import asdict, dataclass, field
from pathlib import Path

from base.gds import write_gds
from base.paths import ROOT
from base.steps import Step, StepError
from base.tools import finish
from models.parameters import check_int, check_real
from platforms.coriolis import coriolis_platform

from ..geometry import macro as macro_module
from ..geometry.macro import Macro
from ..netlist import netlist as netlist_module
from ..netlist.names import plain_names
from ..netlist.netlist import SUPPLIES, Instance, Netlist

OVER_UM = 0.4  # that wires of a block may lie over its edge: half a wire on a track there
MODEL = "talbot_block"  # Coriolis works in lower case
BLOCK = "macro"  # and a number: a block's cell in Coriolis
PHASES = ("clock_tree", "placement", "power", "routing")


@dataclass(frozen=True)
class PlaceRouteParameters:
    """pdk: process. clock: name of the clock port, '' without one. effort: of the placer, 1..3.

    density_variation: how unevenly the placer may spread the empty sites; what is packed does not route.
    strap_pitch_um: of a pair of power straps. events: most moves of the router. macros: modules laid out before.
    """

    pdk: str = "sky130"
    clock: str = "clk"
    effort: int = 2
    density_variation: float = 0.05
    strap_pitch_um: float = field(default=45.0, metadata={"unit": "um"})
    events: int = 4_000_000
    macros: tuple = ()

    def __post_init__(self):
        check_int("effort", self.effort, 1, 3)
        check_real("density_variation", self.density_variation, 0.01, 0.9)
        check_real("strap_pitch_um", self.strap_pitch_um, 10, 1000)
        check_int("events", self.events, 1000, 100_000_000)


class PlaceRoute(Step):
    """Everything between a floorplan and a routed layout happens in one database, which Coriolis cannot store."""

    name = "place_route"
    inputs = {
        "netlist": "synthesis.netlist",
        "floorplan": "floorplan.floorplan",
        "coriolis": "library.coriolis",
        "geometry": "library.geometry",
    }
    uses = (macro_module, netlist_module)
    outputs = {
        "gds": "routed.gds",
        "netlist": "netlist.json",
        "placement": "placement.json",
        "shapes": "shapes.json",
        "log": "coriolis.log",
    }
    Parameters = PlaceRouteParameters
    metrics = {
        "routed": "",
        "stopped": "",
        "open_segments": "",
        "wire_um": "um",
        "vias": "",
        "clock_buffers": "",
        **{f"{name}_s": "s" for name in PHASES},
    }
    tools = ("python coriolis-eda", "python klayout")

    def __init__(self, parameters):
        super().__init__(parameters)
        self.inputs = self.inputs | {module: f"macro.{module}.lef" for module in parameters.macros}

    def run(self, inputs, outputs):
        netlist = Netlist.read(inputs["netlist"])
        names = plain_names(netlist, self.parameters.clock)
        plan = json.loads(inputs["floorplan"].read_text())
        blocks = plain_blocks(netlist, plan["macros"])
        request = self.request(inputs, plan, names, netlist, blocks)
        with tempfile.TemporaryDirectory(dir=outputs["log"].parent) as work:
            result = self.coriolis(Path(work), netlist.blif(MODEL, names, blocks), request, outputs)
        if "stopped" in result:
            for name in ("gds", "netlist", "placement", "shapes"):
                outputs[name].write_text("")
            return dict.fromkeys(self.metrics) | {"routed": False, "stopped": result["stopped"]}
        make_solid(outputs["gds"], request["macros"], coriolis_platform(self.parameters.pdk))
        final = routed_netlist(netlist, names, result["instances"], blocks)
        final.write(outputs["netlist"])
        outputs["placement"].write_text(json.dumps(placement(names, result), indent=0) + "\n")
        wires = [wire for net in result["segments"].values() for wire in net]
        cells = sum(bool(instance.pins) for instance in final.instances)
        return {
            "routed": result["routed"],
            "stopped": None,
            "open_segments": open_segments(outputs["log"].read_text()),
            "wire_um": round(sum(wire[1] for wire in wires), 1),
            "vias": sum(not wire[1] for wire in wires),
            "clock_buffers": cells - len(netlist.instances),
            **{f"{name}_s": round(result["times"].get(name, 0), 2) for name in PHASES},
        }

    def coriolis(self, work, blif, request, outputs):
        """Run it in the folder ``work``; returns its result (dict), {"stopped": its last words} if it gave up."""
        (work / f"{MODEL}.blif").write_text(blif)
        (work / "request.json").write_text(json.dumps(request))
        done = finish(
            [sys.executable, "-m", "flow.layout.coriolis", "request.json"], cwd=work, env={"PYTHONPATH": str(ROOT)}
        )
        outputs["log"].write_text(done.stdout + done.stderr)
        if done.returncode or not (work / "result.json").exists():
            said = [line for line in outputs["log"].read_text().splitlines() if "rror" in line or "coriolis:" in line]
            return {"stopped": (said or ["it ended without a word"])[-1].strip()}
        next(work.glob("*.gds")).replace(outputs["gds"])
        (work / "shapes.json").replace(outputs["shapes"])
        return json.loads((work / "result.json").read_text())

    def request(self, inputs, plan, names, netlist, blocks):
        """What Coriolis is asked for."""
        p = self.parameters
        known = coriolis_platform(p.pdk)
        return {
            "cell": MODEL,
            "library": str(inputs["coriolis"].resolve()),
            "clock_tree": bool(p.clock),
            **{name: plan[name] for name in ("width_um", "height_um", "tree")},
            "macros": [
                self.macro(inputs, block, netlist, *blocks[block["instance"]], known) for block in plan["macros"]
            ],
            "pins": {side: [names[net] for net in nets] for side, nets in plan["pins"].items()},
            "metals": [asdict(metal) for metal in known.metals],
            "vias": [asdict(via) for via in known.vias],
            **{
                name: getattr(known, name)
                for name in ("row_um", "grid_um", "strap_um", "rail_overlap_um", "pin_pitch_um")
            },
            "over_um": OVER_UM,
            **{name: getattr(p, name) for name in ("effort", "density_variation", "strap_pitch_um", "events")},
        }

    def macro(self, inputs, block, netlist, name, pins, known):
        """A block laid out before, by its LEF, as Coriolis is told of it; its pins as [pin, whether it leads anywhere,
        direction, wire, box]."""
        macro = Macro.read(inputs[block["cell"]], known)
        ends = Counter(net for instance in netlist.instances for net in instance.pins.values())
        ends.update(net for port in netlist.ports for net in port.bits())
        nets = next(instance.pins for instance in netlist.instances if instance.name == block["instance"])
        return {
            "name": name,
            "straps": macro.straps,
            **{key: block[key] for key in ("x_um", "y_um", "width_um", "height_um", "outer")},
            "pins": [[pins[pin], ends[nets[pin]] > 1, *piece] for pin, piece in macro.pins.items()],
        }


def plain_blocks(netlist, placed):
    """dict instance -> (cell, dict pin -> name) as Coriolis knows a block of the floorplan's list ``placed``."""
    found = {instance.name: instance for instance in netlist.instances}
    return {
        block["instance"]: (f"{BLOCK}{k}", {pin: f"p{j}" for j, pin in enumerate(found[block["instance"]].pins)})
        for k, block in enumerate(placed)
    }


def make_solid(gds, blocks, known):
    """In the file ``gds``, make the cells of ``blocks`` (their entries for Coriolis) solid on all wires but the lowest,
    but for the wires at their pins: for who routes after Coriolis, there is no way through a block."""
    import klayout.db as db

    if not blocks:
        return
    layout = db.Layout()
    layout.read(str(gds))
    for block in blocks:
        cell, (left, bottom, *_) = layout.cell(block["name"]), block["outer"]
        x, y = block["x_um"] - left, block["y_um"] - bottom
        solid = db.DBox(x - OVER_UM, y - OVER_UM, x + block["width_um"] + OVER_UM, y + block["height_um"] + OVER_UM)
        inside, keep_off = layout.create_cell(f"{block['name']}_solid"), max(known.pin_pitch_um.values())
        cell.insert(db.CellInstArray(inside.cell_index(), db.Trans()))
        for wire in known.metals[1:]:
            layer = layout.layer(*wire.gds)
            pins = db.Region(cell.shapes(layer)).sized(round(keep_off / layout.dbu))
            inside.shapes(layer).insert(db.Region(solid.to_itype(layout.dbu)) - pins)
    write_gds(layout, gds)


def routed_netlist(netlist, names, placed, blocks):
    """The netlist with what Coriolis added: the clock tree's buffers, and the cells that fill gaps.

    placed: [name, cell, x, y, orientation, {pin: net}] of every instance. blocks: see `plain_blocks`. Raises StepError
    if an instance went lost.
    """
    nets, instances, seen = {plain: net for net, plain in names.items()}, [], set()
    for name, cell, *_, pins in placed:
        pins = {pin: nets.get(net, f"cts_{net}") for pin, net in pins.items() if pin not in SUPPLIES}
        number = _number(name)
        if number is not None:
            seen.add(number)
            was = netlist.instances[number]
            name = was.name
            if name in blocks:
                cell, pins = was.cell, {pin: pins[plain] for pin, plain in blocks[name][1].items()}
        instances.append(Instance(name, cell, pins))
    if len(seen) != len(netlist.instances):
        raise StepError(f"place_route: {len(netlist.instances) - len(seen)} instances are not in the layout")
    return Netlist(netlist.name, netlist.ports, tuple(instances))


def _number(name):
    """Place in the BLIF file of an instance that came from it, or None."""
    match = re.fullmatch(r"subckt_(\d+)_\w+", name)
    return int(match[1]) if match else None


def placement(names, result):
    """What reports and the extraction want to know of the layout, nets by their own names."""
    nets = {plain: net for net, plain in names.items()}
    return {
        "straps": result["straps"],
        "pins": [[side, nets[net], at] for side, net, at in result["pins"]],
        "instances": [[number, *rest[:4]] for number, rest in ((_number(i[0]), i[1:]) for i in result["instances"])],
        "segments": {nets.get(net, f"cts_{net}"): wires for net, wires in result["segments"].items()},
    }


def open_segments(log):
    """Wires that the router gave up."""
    found = re.search(r"Track Segment.*\[(\d+)\+(\d+)\]", log)
    return int(found[2]) if found else 0
