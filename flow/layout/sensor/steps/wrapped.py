"""The die's plan and GDS in a shuttle's wrapper."""

import json
from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from talbot.base.gds import read_gds
from talbot.base.steps import Files
from talbot.flow.layout.sensor import arrange, routing
from talbot.flow.layout.sensor.plan import BLOCKS, CORE
from talbot.flow.layout.sensor.steps.die_gds import DieGds
from talbot.flow.layout.sensor.steps.die_plan import TOP, DiePlan, as_json
from talbot.flow.layout.sensor.wrapper import Surround
from talbot.platforms.die import top_metal
from talbot.platforms.layers import Layer
from talbot.platforms.layout import layout_platform

if TYPE_CHECKING:
    import klayout.db as kdb


class WrappedPlan(DiePlan):
    """`DiePlan` with the pins of a wrapper around the blocks. pads: pins of the wrapper that carry a net."""

    inputs = {**{name: source for name, source in DiePlan.inputs.items() if name != "pads"}, "wrapper": "wrapper"}
    outputs = {**DiePlan.outputs, "pins": "pins.md"}

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        p, tech = self.parameters, layout_platform(self.parameters.pdk)
        around = Surround.read(inputs["wrapper"], p.pdk)
        die = around.die(p.die)
        rules, blocks, extra = self.read(inputs)
        layers = [tech.metals[level].lef for level in (routing.STUB, routing.BRANCH)]
        tracks = routing.Tracks.of(rules, die)
        outside = partial(around.branches, die=die, tracks=tracks)
        made = arrange.arranged(blocks, die, tracks, layers, outside, extra)
        metal, field = self.metal(made, die, tracks, rules, around)
        metal += around.metal(die, rules, top_metal(p.pdk), made.routes)
        carried = around.carried(made.routes)
        plan = as_json(made, metal, die, tracks, field) | {
            "cell": around.wrapper.cell,
            "ring": [],
            "nets": around.nets(made.nets, carried),
        }
        outputs["plan"].write_text(json.dumps(plan) + "\n", encoding="utf-8")
        outputs["verilog"].write_text(around.verilog(TOP, made.blocks, made.nets, carried), encoding="utf-8")
        outputs["pins"].write_text(around.table(carried), encoding="utf-8")
        return self.figures(made, die, field) | {"pads": sum(map(len, carried.values()))}


class WrappedGds(DieGds):
    """`DieGds` with the pins of a wrapper; pads, fill and seal ring are the shuttle's."""

    inputs = {f"{block}.gds": f"{block}.gds" for block in (*BLOCKS, CORE)}
    inputs |= {"plan": "die_plan.plan", "rules": "library.rules", "wrapper": "wrapper"}

    def around(
        self, plan: Mapping[str, Any], layout: "kdb.Layout", top: "kdb.Cell", inputs: Files, metals: Sequence[Layer]
    ) -> "tuple[list[kdb.Cell], list[kdb.Cell], dict[str, float]]":
        """Put the wrapper's pins into the die."""
        source = read_gds(inputs["wrapper"])
        for metal in metals:
            for numbers in (metal.gds, metal.pin):
                top.shapes(layout.layer(*numbers)).insert(source.top_cell().shapes(source.layer(*numbers)))
        return [], [], {}
