"""Placement and routing of the die."""

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import partial
from typing import Any

from talbot.base.steps import Files, Step
from talbot.flow.layout.sensor import arrange, decoupling, ring, routing, supplies, verilog
from talbot.flow.layout.sensor.arrange import Arranged
from talbot.flow.layout.sensor.plan import BLOCKS, CORE, Block, DieParameters, NoRoom, driver, nm
from talbot.flow.layout.sensor.ring import Frame, Pads, Place
from talbot.flow.layout.sensor.rules import RoutingRules
from talbot.flow.layout.sensor.shapes import Shape, drawn
from talbot.platforms.die import top_metal
from talbot.platforms.layers import Layer
from talbot.platforms.layout import layout_platform
from talbot.platforms.pads import pad_process
from talbot.signoff.black_box import extra_pins

TOP = "asp_sensor"
COUNTS = "utilization", "nets", "routed", "abutted", "tracks", "pads"
Shapes = Sequence[Shape]


@dataclass(frozen=True)
class DiePlanParameters:
    """Process, sizes of the die."""

    pdk: str = "sky130"
    die: DieParameters = field(default_factory=DieParameters)


class DiePlan(Step[DiePlanParameters]):
    """Placement from the LEFs alone; a channel of signals below all blocks; supplies on the top metal; a ring of pads.

    A pin that a block's black box does not have, a reference or a bias, leads to a pin of the die.

    pads: of the ring. routed: nets in the channel. abutted: nets whose pins touch. tracks: of the channel. wire_um: of
    the signals.
    """

    name = "die_plan"
    inputs = {f"{block}.lef": f"{block}.lef" for block in (*BLOCKS, CORE)}
    inputs |= {f"{block}.black_box": f"{block}.black_box" for block in BLOCKS}
    inputs |= {"rules": "library.rules", "pads": "die_pads.pins"}
    outputs = {"plan": "plan.json", "verilog": f"{TOP}.v"}
    metrics = {"area_um2": "um2", **dict.fromkeys(COUNTS, ""), "wire_um": "um", "decoupling_pf": "pF"}

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        die = self.parameters.die
        rules, blocks, extra = self.read(inputs)
        cells = json.loads(inputs["pads"].read_text(encoding="utf-8"))
        sizes = {name for name in ("width_um", "height_um") if getattr(die, name)}
        while True:
            try:
                plan, text, metrics = self.planned(die, rules, blocks, cells, extra)
                break
            except NoRoom as reason:
                if reason.size in sizes or len(sizes) == 2:
                    raise
                die = die.larger(reason)
        outputs["plan"].write_text(json.dumps(plan) + "\n", encoding="utf-8")
        outputs["verilog"].write_text(text, encoding="utf-8")
        return metrics

    def read(self, inputs: Files) -> tuple[RoutingRules, dict[str, Block], list[str]]:
        """Rules, blocks, and the pins that these have and their black boxes lack."""
        tech = layout_platform(self.parameters.pdk)
        rules = RoutingRules.of(tech, json.loads(inputs["rules"].read_text(encoding="utf-8")))
        blocks = {name: Block.read(name, inputs[f"{name}.lef"].read_text(encoding="utf-8")) for name in (*BLOCKS, CORE)}
        extra = [pin for block in BLOCKS for pin in extra_pins(inputs[f"{block}.lef"], inputs[f"{block}.black_box"])]
        return rules, blocks, extra

    def planned(
        self, die: DieParameters, rules: RoutingRules, blocks: dict[str, Block], cells: ring.Pins, extra: Iterable[str]
    ) -> tuple[dict[str, Any], str, dict[str, Any]]:
        """Return plan, Verilog and metrics of a die of this size. Raises ParameterError, StepError."""
        p, tech = self.parameters, layout_platform(self.parameters.pdk)
        layers = [tech.metals[level].lef for level in (routing.STUB, routing.BRANCH)]
        tracks, pads = routing.Tracks.of(rules, die), self.pads(die, cells, {})
        outside = partial(routing.pad_branches, die=die, tracks=tracks, pads=pads)
        made = arrange.arranged(blocks, die, tracks, layers, outside, extra)
        signals = [
            ring.signal(net, kind, at - offset, pads.process, branch.side)
            for net, found in made.routes.items()
            for branch in found
            if branch.block == "die"
            for kind in [ring.function(net, driver(made.blocks, made.nets[net])[0] == CORE)]
            for offset in [ring.middle(pads.core_pin(kind))]
            for at in [branch.x if branch.side == "south" else branch.end]
        ]
        borders = {"west": made.blocks[CORE].box[3], "east": made.blocks["pixel_array"].y}
        for place in (place for place in signals if place.side != "south"):
            borders[place.side] = max(borders[place.side], place.at + pads.frame.pad)
        pads = replace(pads, borders={side: y // ring.UM * ring.UM for side, y in borders.items()})
        metal, field = self.metal(made, die, tracks, rules, pads)
        places, gaps = ring.ring(pads, signals, supplies.ways(made.blocks, die, top_metal(p.pdk)))
        levels = [*tech.metals, top_metal(p.pdk).metal]
        metal += [drawn(levels[level], net, box) for net, level, box in ring.bridges(pads, gaps)]
        plan = as_json(made, metal, die, tracks, field) | in_ring(made, places, pads, levels[-1])
        metrics = self.figures(made, die, field) | {"pads": sum(bool(place.nets) for place in places)}
        return plan, verilog.top(TOP, made.blocks, made.nets, places), metrics

    def metal(
        self, made: Arranged, die: DieParameters, tracks: routing.Tracks, rules: RoutingRules, around: supplies.Around
    ) -> tuple[list[Shape], decoupling.Field]:
        """Metal of routes, supplies and capacitors; the capacitors."""
        top = top_metal(self.parameters.pdk)
        metal = supplies.metal(made, die, tracks, rules, top, around)
        lines = supplies.crossing(made.blocks, die, top, "adc_lanes")
        taken = [branch.x for found in made.routes.values() for branch in found]
        field = decoupling.field(made.blocks, taken, die)
        return [*metal, *decoupling.metal(field, lines, rules, top)], field

    def figures(self, made: Arranged, die: DieParameters, field: decoupling.Field) -> dict[str, Any]:
        """Metrics but those of the pads."""
        area = die.width_um * die.height_um
        covered = sum(block.width * block.height for block in made.blocks.values()) / 1e6
        return {
            "area_um2": area,
            "utilization": round(covered / area, 4),
            "nets": len(made.nets),
            "routed": len(made.routes),
            "abutted": made.abutted,
            "tracks": made.count,
            "decoupling_pf": round(decoupling.picofarad(field, pad_process(self.parameters.pdk).capacitor), 1),
            "wire_um": round(made.wire / 1000, 1),
        }

    def pads(self, die: DieParameters, cells: ring.Pins, borders: Mapping[str, int]) -> Pads:
        """The pads in the frame of the die."""
        process = pad_process(self.parameters.pdk)
        depth, width = nm(process.height_um), nm(process.width_um)
        frame = Frame(nm(die.width_um), nm(die.height_um), nm(die.ring_um) - depth, depth, width)
        return Pads(frame, cells, process, borders)


def as_json(
    made: Arranged, metal: Shapes, die: DieParameters, tracks: routing.Tracks, field: decoupling.Field
) -> dict[str, Any]:
    """The plan inside of the pads for JSON, nm. metal: all shapes."""
    blocks, routes = made.blocks.items(), made.routes.items()
    return {
        "die": [nm(die.width_um), nm(die.height_um)],
        "blocks": {name: {"cell": b.cell, "orientation": b.orientation, "box": b.box} for name, b in blocks},
        "drivers": {net: driver(made.blocks, made.nets[net]) for net in made.routes},
        "channel": made.channel,
        "tracks": asdict(tracks),
        "shapes": [_plain(shape) for shape in metal],
        "routes": {net: {"y": made.y[net], "branches": list(map(asdict, found))} for net, found in routes},
        "decoupling": field._asdict(),
    }


def in_ring(made: Arranged, places: Sequence[Place], pads: Pads, top: Layer) -> dict[str, Any]:
    """What the plan adds with a ring of pads. places: of the ring. top: metal of the bond pads, the die's pins."""
    pins: dict[str, list[Any]] = {}
    for place in (place for place in places if place.nets):
        pin = ring.bond(place, pads.process)
        box = max((box for level, *box in pads.cells[place.cell][pin] if level == ring.TOP), key=_area)
        pins.setdefault(place.nets[pin], []).append(
            _plain(drawn(top, place.nets[pin], pads.frame.box(place.side, place.at, box)))
        )
    return {
        "cell": TOP,
        "ring": [place._asdict() | {"box": pads.box(place)} for place in places],
        "frame": asdict(pads.frame),
        "corner": pads.process.corner,
        "nets": ring.nets(made.nets, places),
        "pins": pins,
    }


def _area(box: Sequence[int]) -> int:
    return (box[2] - box[0]) * (box[3] - box[1])


def _plain(shape: Shape) -> list[Any]:
    return [shape.net, shape.layer, shape.datatype, *shape.box]
