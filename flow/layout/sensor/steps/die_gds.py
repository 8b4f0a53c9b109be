"""The GDS of the die."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from talbot.base.gds import read_gds, write_gds
from talbot.base.steps import Files, Step, StepError
from talbot.flow.layout.sensor import decoupling, outside, seal
from talbot.flow.layout.sensor.plan import BLOCKS, CORE, ORIENTATIONS
from talbot.flow.layout.sensor.ring import Frame
from talbot.flow.layout.sensor.rules import RoutingRules
from talbot.flow.layout.sensor.steps.die_plan import TOP
from talbot.platforms.die import seal_ring, top_metal
from talbot.platforms.layers import Layer
from talbot.platforms.layout import layout_platform
from talbot.platforms.pads import pad_process

if TYPE_CHECKING:
    import klayout.db as kdb


PIXELS = "pixel_"  # cells of pixels in a drawn array have names that begin so


@dataclass(frozen=True)
class DieGdsParameters:
    """Process. drawn: blocks whose pixels are checked apart, in a small array (`make pixel-layout`)."""

    pdk: str = "sky130"
    drawn: tuple[str, ...] = ()


class DieGds(Step[DieGdsParameters]):
    """The blocks' GDS at the places of the plan, the ring of pads, the seal ring, and the plan's metal.

    outside_density: by metal, share of the area outside of blocks and pads that wires and fill cover. checked: the same
    without the pixels of drawn arrays, for rules and antennas, which see every shape of each of 150,000 pixels, with
    the pads' metals alone, and without the seal ring; what is around the pixels stays.
    """

    name = "die_gds"
    inputs = {f"{block}.gds": f"{block}.gds" for block in (*BLOCKS, CORE)} | {"plan": "die_plan.plan"}
    inputs |= {"pads.gds": "die_pads.gds", "rules": "library.rules"}
    outputs = {"gds": f"{TOP}.gds", "checked": "checked.gds"}
    metrics = {"rectangles": "", "outside_density": ""}
    tools = ("python klayout",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        import klayout.db as db

        plan, layout = json.loads(inputs["plan"].read_text(encoding="utf-8")), db.Layout()
        tech = layout_platform(self.parameters.pdk)
        layout.dbu = 0.001
        top = layout.create_cell(plan["cell"])
        cells = self.blocks(plan, layout, top, inputs)
        for _, layer, datatype, *box in plan["shapes"]:
            top.shapes(layout.layer(layer, datatype)).insert(db.Box(*box))
        top.shapes(layout.layer(*tech.outline)).insert(db.Box(0, 0, *plan["die"]))
        rules = RoutingRules.of(tech, json.loads(inputs["rules"].read_text(encoding="utf-8")))
        decoupling.draw(layout, plan, rules, pad_process(self.parameters.pdk).capacitor)
        metals = *tech.metals, top_metal(self.parameters.pdk).metal
        pads, walls, shares = self.around(plan, layout, top, inputs, metals)
        write_gds(layout, outputs["gds"])
        for wall in walls:
            wall.prune_cell()
        for name in self.parameters.drawn:
            inner = [layout.cell(index) for index in cells[name].each_child_cell()]
            for cell in inner:
                if cell.name.startswith(PIXELS):
                    cell.prune_cell()
        routed = {metal.gds for metal in metals[1:]}
        for cell in pads:
            for index in layout.layer_indexes():
                if (layout.get_info(index).layer, layout.get_info(index).datatype) not in routed:
                    cell.clear(index)
        write_gds(layout, outputs["checked"])
        return {"rectangles": len(plan["shapes"]), "outside_density": shares}

    def blocks(
        self, plan: Mapping[str, Any], layout: "kdb.Layout", top: "kdb.Cell", inputs: Files
    ) -> "dict[str, kdb.Cell]":
        """Put the blocks into the die; returns their cells."""
        import klayout.db as db

        cells = {name: layout.create_cell(block["cell"]) for name, block in plan["blocks"].items()}
        for name, block in plan["blocks"].items():
            source = read_gds(inputs[f"{name}.gds"])
            tops = [cell.name for cell in source.top_cells()]
            if tops != [block["cell"]]:
                has = f"{inputs[f'{name}.gds'].name} has the top cells {', '.join(tops)}"
                raise StepError(f"die_gds: {has}; its LEF is of {block['cell']}")
            cells[name].copy_tree(source.top_cell())  # renames cells in it whose name is taken
            top.insert(db.CellInstArray(cells[name].cell_index(), placed(block)))
        return cells

    def around(
        self, plan: Mapping[str, Any], layout: "kdb.Layout", top: "kdb.Cell", inputs: Files, metals: Sequence[Layer]
    ) -> "tuple[list[kdb.Cell], list[kdb.Cell], dict[str, float]]":
        """Put ring, pins, fill and seal ring into the die: (cells of pads, of the seal ring, outside_density)."""
        import klayout.db as db

        tech = layout_platform(self.parameters.pdk)
        pads = self.ring(plan, layout, top, inputs["pads.gds"])
        for net, boxes in plan["pins"].items():
            for _, layer, _, *box in boxes:
                middle = db.Trans(db.Box(*box).center() - db.Point())
                for datatype in (tech.pin_datatype, tech.label_datatype):
                    top.shapes(layout.layer(layer, datatype)).insert(db.Text(net, middle))
        shares = outside.fill(layout, top, plan, metals)
        width, height = (side * layout.dbu for side in plan["die"])
        wall = seal.draw(layout, width, height, seal_ring(self.parameters.pdk), tech.grid_um)
        top.insert(db.CellInstArray(wall.cell_index(), db.Trans()))
        return pads, [wall], shares

    def ring(self, plan: Mapping[str, Any], layout: "kdb.Layout", top: "kdb.Cell", gds: Path) -> "list[kdb.Cell]":
        """Put the ring's cells into the die; returns them."""
        import klayout.db as db

        source, frame = read_gds(gds), Frame(**plan["frame"])
        cells = {}
        for name in {place["cell"] for place in plan["ring"]} | {plan["corner"]}:
            cells[name] = layout.create_cell(name)
            cells[name].copy_tree(source.cell(name))
        at = [(place["cell"], turned(frame, place["side"], place["at"])) for place in plan["ring"]]
        at += [(plan["corner"], trans) for trans in corners(frame)]
        for name, trans in at:
            top.insert(db.CellInstArray(cells[name].cell_index(), trans))
        return list(cells.values())


def turned(frame: Frame, side: str, at: int) -> "kdb.Trans":
    """Transformation of a cell of the ring, drawn as in the south."""
    import klayout.db as db

    return {
        "south": db.Trans(db.Trans.R0, at, frame.seal),
        "north": db.Trans(db.Trans.M0, at, frame.height - frame.seal),
        "west": db.Trans(db.Trans.M45, frame.seal, at),
        "east": db.Trans(db.Trans.R90, frame.width - frame.seal, at),
    }[side]


def corners(frame: Frame) -> "list[kdb.Trans]":
    """Transformations of the corner, drawn as in the south-west with the ring's inside at x = 0."""
    import klayout.db as db

    west, east, low, high = frame.inner, frame.width - frame.inner, frame.seal, frame.height - frame.seal
    ways = (db.Trans.R0, west, low), (db.Trans.M90, east, low), (db.Trans.R180, east, high), (db.Trans.M0, west, high)
    return [db.Trans(*way) for way in ways]


def placed(block: Mapping[str, Any]) -> "kdb.Trans":
    """Transformation of a block of the plan."""
    import klayout.db as db

    left, bottom, right, top = block["box"]
    sideways, upright = ORIENTATIONS[block["orientation"]]
    turn = ((db.Trans.R0, db.Trans.M0), (db.Trans.M90, db.Trans.R180))[sideways][upright]
    return db.Trans(turn, right if sideways else left, top if upright else bottom)
