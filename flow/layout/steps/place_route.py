"""Power, placement, clock tree and routing: Coriolis, in a process of its own."""

import json
import re
import sys
import tempfile
from dataclasses import asdict, dataclass, field
from pathlib import Path

from flow.platforms.embedded import process
from flow.simulate.process import finish
from flow.steps import Step, StepError
from models.parameters import check_int, check_real

from ..coriolis.session import CLOCK
from .. import netlist as netlist_module
from ..netlist import SUPPLIES, Instance, Netlist

ROOT = Path(__file__).parents[3]
MODEL = "talbot_block"          # Coriolis works in lower case
PHASES = ("clock_tree", "placement", "power", "routing")


@dataclass(frozen=True)
class PlaceRouteParameters:
    """pdk: process. clock: name of the clock port, '' without one. effort: of the placer, 1..3.

    density_variation: how unevenly the placer may spread the empty sites; what is packed does not route.
    strap_pitch_um: of a pair of power straps. events: most moves of the router.
    """

    pdk: str = "sky130"
    clock: str = "clk"
    effort: int = 2
    density_variation: float = 0.05
    strap_pitch_um: float = field(default=45.0, metadata={"unit": "um"})
    events: int = 4_000_000

    def __post_init__(self):
        check_int("effort", self.effort, 1, 3)
        check_real("density_variation", self.density_variation, 0.01, 0.9)
        check_real("strap_pitch_um", self.strap_pitch_um, 10, 1000)
        check_int("events", self.events, 1000, 100_000_000)


class PlaceRoute(Step):
    """Everything between a floorplan and a routed layout happens in one database, which Coriolis cannot store."""

    name = "place_route"
    inputs = {"netlist": "synthesis.netlist", "floorplan": "floorplan.floorplan", "coriolis": "library.coriolis",
              "geometry": "library.geometry", "scripts": "coriolis_scripts"}
    uses = (netlist_module,)
    outputs = {"gds": "routed.gds", "netlist": "netlist.json", "placement": "placement.json",
               "shapes": "shapes.json", "log": "coriolis.log"}
    Parameters = PlaceRouteParameters
    metrics = {"routed": "", "stopped": "", "open_segments": "", "wire_um": "um", "vias": "", "clock_buffers": "",
               **{f"{name}_s": "s" for name in PHASES}}
    tools = ("python coriolis-eda",)

    def run(self, inputs, outputs):
        netlist = Netlist.read(inputs["netlist"])
        names = plain_names(netlist, self.parameters.clock)
        with tempfile.TemporaryDirectory(dir=outputs["log"].parent) as work:
            result = self.coriolis(Path(work), netlist.blif(MODEL, names), self.request(inputs, names), outputs)
        if "stopped" in result:
            for name in ("gds", "netlist", "placement", "shapes"):
                outputs[name].write_text("")
            return dict.fromkeys(self.metrics) | {"routed": False, "stopped": result["stopped"]}
        final = routed_netlist(netlist, names, result["instances"])
        final.write(outputs["netlist"])
        outputs["placement"].write_text(json.dumps(placement(names, result), indent=0) + "\n")
        wires = [wire for net in result["wires"].values() for wire in net]
        cells = sum(bool(instance.pins) for instance in final.instances)
        return {"routed": result["routed"], "stopped": None, "open_segments": open_segments(outputs["log"].read_text()),
                "wire_um": round(sum(wire[1] for wire in wires), 1),
                "vias": sum(not wire[1] for wire in wires), "clock_buffers": cells - len(netlist.instances),
                **{f"{name}_s": round(result["times"].get(name, 0), 2) for name in PHASES}}

    def coriolis(self, work, blif, request, outputs):
        """Run it in the folder ``work``; returns its result (dict), {"stopped": its last words} if it gave up."""
        (work / f"{MODEL}.blif").write_text(blif)
        (work / "request.json").write_text(json.dumps(request))
        done = finish([sys.executable, "-m", "flow.layout.coriolis", "request.json"], cwd=work,
                      env={"PYTHONPATH": str(ROOT)})
        outputs["log"].write_text(done.stdout + done.stderr)
        if done.returncode or not (work / "result.json").exists():
            said = [line for line in outputs["log"].read_text().splitlines() if "rror" in line or "coriolis:" in line]
            return {"stopped": (said or ["it ended without a word"])[-1].strip()}
        next(work.glob("*.gds")).replace(outputs["gds"])
        (work / "shapes.json").replace(outputs["shapes"])
        return json.loads((work / "result.json").read_text())

    def request(self, inputs, names):
        """What Coriolis is asked for."""
        p = self.parameters
        known, _ = process(p.pdk)
        plan = json.loads(inputs["floorplan"].read_text())
        return {"cell": MODEL, "library": str(inputs["coriolis"].resolve()), "clock_tree": bool(p.clock),
                **{name: plan[name] for name in ("width_um", "height_um")},
                "pins": {side: [names[net] for net in nets] for side, nets in plan["pins"].items()},
                "wires": [asdict(wire) for wire in known.wires], "cuts": [asdict(cut) for cut in known.cuts],
                **{name: getattr(known, name) for name in ("row_um", "grid_um", "strap_um", "rail_overlap_um",
                                                           "pin_pitch_um")},
                **{name: getattr(p, name) for name in ("effort", "density_variation",
                                                       "strap_pitch_um", "events")}}


def plain_names(netlist, clock):
    """dict net -> the name that Coriolis gets: letters and digits only, CLOCK for the net ``clock``."""
    nets = dict.fromkeys(net for port in netlist.ports for net in port.bits())
    nets.update(dict.fromkeys(net for instance in netlist.instances for net in instance.pins.values()))
    return {net: CLOCK if net == clock else f"w{number}" for number, net in enumerate(nets)}


def routed_netlist(netlist, names, placed):
    """The netlist with what Coriolis added: the clock tree's buffers, and the cells that fill gaps.

    placed: [name, cell, x, y, orientation, {pin: net}] of every instance. Raises StepError if an instance went lost.
    """
    nets, instances, seen = {plain: net for net, plain in names.items()}, [], set()
    for name, cell, *_, pins in placed:
        pins = {pin: nets.get(net, f"cts_{net}") for pin, net in pins.items() if pin not in SUPPLIES}
        number = _number(name)
        if number is not None:
            seen.add(number)
            name = netlist.instances[number].name
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
    return {"straps": result["straps"], "pins": [[side, nets[net], at] for side, net, at in result["pins"]],
            "instances": [[number, *rest[:4]] for number, rest in ((_number(i[0]), i[1:]) for i in result["instances"])],
            "wires": {nets.get(net, f"cts_{net}"): wires for net, wires in result["wires"].items()}}


def open_segments(log):
    """Wires that the router gave up."""
    found = re.search(r"Track Segment.*\[(\d+)\+(\d+)\]", log)
    return int(found[2]) if found else 0
