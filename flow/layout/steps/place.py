"""Power, placement and clock tree: Coriolis, in a process of its own."""

import json
import sys
import tempfile
from collections import Counter
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from talbot.base.gds import read_gds, write_gds
from talbot.base.paths import ROOT
from talbot.base.steps import Files, Step
from talbot.base.tools import finish
from talbot.models.parameters import check_real
from talbot.platforms.coriolis import coriolis_platform

from ..geometry.macro import Macro
from ..geometry.macro_cells import OVER_UM, make_solid
from ..netlist.names import plain_macros, plain_names
from ..netlist.netlist import MacroNames, Netlist
from ..netlist.placed import own_name, placed_netlist, placement
from ..route.ports import draw_ports, edge_ports, label_straps
from ..route.rules import RoutingRules

MODEL = "talbot_block"  # Coriolis works in lower case
OF_TECH = ("row_um", "grid_um", "strap_um", "rail", "rail_um", "rail_overlap_um", "rails_over_edge", "pin_pitch_um")
LEAF_ROWS, LEAF_SINKS = 8, 6  # of a leaf of the clock tree: its least side (Coriolis takes no less than 7), its sinks
PHASES = ("clock_tree_s", "placement_s", "power_s")


@dataclass(frozen=True)
class PlaceParameters:
    """Parameters of `Place`.

    pdk: process. clock: name of the clock port, '' without one. strap_pitch_um: of a pair of power straps.
    macros: modules laid out before.
    """

    pdk: str = "sky130"
    clock: str = "clk"
    strap_pitch_um: float = field(default=45.0, metadata={"unit": "um"})
    macros: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        check_real("strap_pitch_um", self.strap_pitch_um, 10, 1000)


class Place(Step[PlaceParameters]):
    """Everything between a floorplan and a placed layout, in one database, which Coriolis cannot store."""

    name = "place"
    inputs = {
        "netlist": "synthesis.netlist",
        "floorplan": "floorplan.floorplan",
        "coriolis": "library.coriolis",
        "geometry": "library.geometry",
        "rules": "library.rules",
    }
    outputs = {
        "gds": "placed.gds",
        "netlist": "netlist.json",
        "placement": "placement.json",
        "shapes": "shapes.json",
        "masters": "masters.json",
        "log": "coriolis.log",
    }
    metrics = {"stopped": "", "clock_buffers": ""} | dict.fromkeys(PHASES, "s")
    tools = ("python coriolis-eda", "python klayout")

    def __init__(self, parameters: PlaceParameters) -> None:
        super().__init__(parameters)
        self.inputs = {**self.inputs, **{module: f"macro.{module}.lef" for module in parameters.macros}}

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        netlist = Netlist.read(inputs["netlist"])
        names = plain_names(netlist, self.parameters.clock)
        plan = json.loads(inputs["floorplan"].read_text(encoding="utf-8"))
        macros = plain_macros(netlist, plan["macros"])
        request = self.request(inputs, plan, names, netlist, macros)
        with tempfile.TemporaryDirectory(dir=outputs["log"].parent) as work:
            result = self.coriolis(Path(work), netlist.blif(MODEL, names, macros), request, outputs)
        if "stopped" in result:
            for name in ("gds", "netlist", "placement", "shapes", "masters"):
                outputs[name].write_text("", encoding="utf-8")
            return dict.fromkeys(self.metrics) | {"stopped": result["stopped"]}
        make_solid(outputs["gds"], request["macros"], coriolis_platform(self.parameters.pdk))
        placed, own = placement(names, result), own_name(names)
        shapes = {own(net): made for net, made in result["shapes"].items()}
        self.ports(plan, placed, shapes, inputs["rules"], outputs)
        masters = result["masters"]
        for name, (cell, pins) in macros.items():
            module = next(instance.cell for instance in netlist.instances if instance.name == name)
            masters[module] = {pin: masters[cell][plain] for pin, plain in pins.items()}
        outputs["masters"].write_text(json.dumps(masters), encoding="utf-8")
        final = placed_netlist(netlist, names, result["instances"], macros)
        final.write(outputs["netlist"])
        outputs["placement"].write_text(json.dumps(placed, indent=0) + "\n", encoding="utf-8")
        cells = sum(bool(instance.pins) for instance in final.instances)
        return {
            "stopped": None,
            "clock_buffers": cells - len(netlist.instances),
            **{name: round(result["times"].get(name.removesuffix("_s"), 0), 2) for name in PHASES},
        }

    def ports(
        self, plan: dict[str, Any], placed: dict[str, Any], shapes: dict[str, Any], rules: Path, outputs: Files
    ) -> None:
        """Draw the ports in place of Coriolis's, which may be on metal of cells, and label the straps."""
        tech, layout = coriolis_platform(self.parameters.pdk), read_gds(outputs["gds"])
        replaced = [box for made in shapes.values() for box in made["ports"]]
        own = RoutingRules.of(tech, json.loads(rules.read_text(encoding="utf-8")))
        ports = plan.get("ports") or edge_ports(placed["pins"], layout.top_cell().bbox(), own, tech)
        drawn = draw_ports(layout, ports, replaced, tech)
        for net, made in shapes.items():
            made["ports"] = [drawn[net]] if net in drawn else []
        label_straps(layout, placed["straps"], tech)
        write_gds(layout, outputs["gds"])
        outputs["shapes"].write_text(json.dumps(shapes), encoding="utf-8")

    def coriolis(self, work: Path, blif: str, request: dict[str, Any], outputs: Files) -> dict[str, Any]:
        """Run it in the folder ``work``; returns its result, {"stopped": its last message} if it gave up."""
        (work / f"{MODEL}.blif").write_text(blif, encoding="utf-8")
        (work / "request.json").write_text(json.dumps(request), encoding="utf-8")
        command = [sys.executable, "-m", "talbot.flow.layout.coriolis", "request.json"]
        done = finish(command, {"PYTHONPATH": str(ROOT)}, work)
        outputs["log"].write_text(done.stdout + done.stderr, encoding="utf-8")
        if done.returncode or not (work / "result.json").exists():
            lines = [
                line
                for line in outputs["log"].read_text(encoding="utf-8").splitlines()
                if "rror" in line or "coriolis:" in line
            ]
            return {"stopped": (lines or ["it ended with no message"])[-1].strip()}
        next(work.glob("*.gds")).replace(outputs["gds"])
        return json.loads((work / "result.json").read_text(encoding="utf-8"))

    def request(
        self, inputs: Files, plan: dict[str, Any], names: Mapping[str, str], netlist: Netlist, macros: MacroNames
    ) -> dict[str, Any]:
        """What flow.layout.coriolis reads, for JSON."""
        p, tech = self.parameters, coriolis_platform(self.parameters.pdk)
        return {
            "cell": MODEL,
            "library": str(inputs["coriolis"].resolve()),
            "clock_tree": bool(p.clock),
            "leaf_um": self.leaf_um(plan, netlist),
            **{name: plan[name] for name in ("width_um", "height_um", "tree")},
            "macros": [
                self.macro(Macro.read(inputs[macro["cell"]], tech), macro, netlist, *macros[macro["instance"]])
                for macro in plan["macros"]
            ],
            "pins": {side: [names[net] for net in nets] for side, nets in plan["pins"].items()},
            "places": [["north", names[net], (box[0] + box[2]) / 2] for net, _, box in plan.get("ports", ())],
            "metals": [asdict(metal) for metal in tech.metals],
            "vias": [asdict(via) for via in tech.vias],
            **{name: getattr(tech, name) for name in OF_TECH},
            "over_um": OVER_UM,
            "strap_pitch_um": p.strap_pitch_um,
        }

    def leaf_um(self, plan: dict[str, Any], netlist: Netlist) -> float:
        """Least side of a leaf of the clock tree, um, so that one with LEAF_SINKS cells can be.

        Coriolis quarters what is at least twice as long on both sides, so the shorter side of the tree's box counts.
        """
        sinks = sum(self.parameters.clock in instance.pins.values() for instance in netlist.instances)
        per_um2 = sinks / (plan["width_um"] * plan["height_um"])
        least = LEAF_ROWS * coriolis_platform(self.parameters.pdk).row_um
        left, bottom, right, top = plan["tree"]
        shorter, longer = sorted((right - left, top - bottom))
        return max(least, round((LEAF_SINKS / per_um2 * shorter / longer) ** 0.5, 3)) if sinks else least

    def macro(
        self, macro: Macro, placed: dict[str, Any], netlist: Netlist, name: str, pins: Mapping[str, str]
    ) -> dict[str, Any]:
        """A macro in the request; its pins as [pin, whether its net has another end, direction, layer, box]."""
        ends = Counter(net for instance in netlist.instances for net in instance.pins.values())
        ends.update(net for port in netlist.ports for net in port.bits())
        nets = next(instance.pins for instance in netlist.instances if instance.name == placed["instance"])
        return {
            "name": name,
            "straps": macro.straps,
            **{key: placed[key] for key in ("x_um", "y_um", "width_um", "height_um", "outer")},
            "pins": [[pins[pin], ends[nets[pin]] > 1, *piece] for pin, piece in macro.pins.items()],
        }
