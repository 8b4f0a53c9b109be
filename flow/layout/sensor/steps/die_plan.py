"""Placement and routing of the die."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

from talbot.base.steps import Files, Step
from talbot.flow.layout.route.rules import RoutingRules
from talbot.platforms.coriolis import coriolis_platform
from talbot.platforms.die import top_metal

from .. import arrange, routing, supplies, verilog
from ..arrange import Arranged
from ..plan import BLOCKS, CORE, Block, DieParameters, driver, nm
from ..shapes import Shape

TOP = "asp_sensor"
COUNTS = "utilization", "nets", "routed", "abutted", "tracks"
Shapes = Sequence[Shape]


@dataclass(frozen=True)
class DiePlanParameters:
    """Process, sizes of the die. extra: pins of analog blocks that lead to pins of the die."""

    pdk: str = "sky130"
    die: DieParameters = field(default_factory=DieParameters)
    extra: tuple[str, ...] = ()


class DiePlan(Step[DiePlanParameters]):
    """Placement from the LEFs alone; signals in one channel below all blocks; supplies on the top metal.

    routed: nets in the channel. abutted: nets whose pins touch. tracks: of the channel. wire_um: of the signals.
    """

    name = "die_plan"
    inputs = {f"{block}.lef": f"{block}.lef" for block in (*BLOCKS, CORE)} | {"rules": "library.rules"}
    outputs = {"plan": "plan.json", "verilog": f"{TOP}.v"}
    metrics = {"area_um2": "um2", **dict.fromkeys(COUNTS, ""), "wire_um": "um"}

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        p, tech = self.parameters, coriolis_platform(self.parameters.pdk)
        rules = RoutingRules.of(tech, json.loads(inputs["rules"].read_text()))
        layers = [tech.metals[level].lef for level in (routing.STUB, routing.BRANCH)]
        blocks = {name: Block.read(name, inputs[f"{name}.lef"].read_text()) for name in (*BLOCKS, CORE)}
        tracks = routing.Tracks.of(rules)
        made = arrange.arranged(blocks, p.die, tracks, layers, p.extra)
        metal, pins = supplies.metal(made, p.die, tracks, rules, top_metal(p.pdk))
        outputs["plan"].write_text(json.dumps(as_json(made, metal, pins, p.die, tracks)) + "\n")
        outputs["verilog"].write_text(verilog.top(TOP, made.blocks, made.nets))
        area = p.die.width_um * p.die.height_um
        covered = sum(block.width * block.height for block in made.blocks.values()) / 1e6
        return {
            "area_um2": area,
            "utilization": round(covered / area, 4),
            "nets": len(made.nets),
            "routed": len(made.routes),
            "abutted": made.abutted,
            "tracks": made.count,
            "wire_um": round(made.wire / 1000, 1),
        }


def as_json(
    made: Arranged, metal: Shapes, pins: Mapping[str, Shapes], die: DieParameters, tracks: routing.Tracks
) -> dict[str, Any]:
    """The plan for JSON, nm. metal: all shapes. pins: those at the die's edge, by net."""
    blocks, routes = made.blocks.items(), made.routes.items()
    return {
        "die": [nm(die.width_um), nm(die.height_um)],
        "blocks": {name: {"cell": b.cell, "orientation": b.orientation, "box": b.box} for name, b in blocks},
        "nets": made.nets,
        "drivers": {net: driver(made.blocks, made.nets[net]) for net in made.routes},
        "channel": made.channel,
        "tracks": asdict(tracks),
        "pins": {net: [_plain(shape) for shape in found] for net, found in pins.items()},
        "shapes": [_plain(shape) for shape in metal],
        "routes": {net: {"y": made.y[net], "branches": list(map(asdict, found))} for net, found in routes},
    }


def _plain(shape: Shape) -> list[Any]:
    return [shape.net, shape.layer, shape.datatype, *shape.box]
