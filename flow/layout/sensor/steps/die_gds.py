"""The GDS of the die."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from talbot.base.gds import write_gds
from talbot.base.steps import Files, Step, StepError
from talbot.platforms.coriolis import coriolis_platform

from ..plan import BLOCKS, CORE, ORIENTATIONS
from .die_plan import TOP

if TYPE_CHECKING:
    import klayout.db as kdb


PIXELS = "pixel_"  # cells of pixels in a drawn array have names that begin so


@dataclass(frozen=True)
class DieGdsParameters:
    """Process. drawn: blocks whose pixels are checked apart, in a small array (`make pixel-layout`)."""

    pdk: str = "sky130"
    drawn: tuple[str, ...] = ()


class DieGds(Step[DieGdsParameters]):
    """The blocks' GDS at the places of the plan, and the plan's metal.

    checked: the same without the pixels of drawn arrays, for rules and antennas, which see every shape of each of
    150,000 pixels; what is around the pixels stays.
    """

    name = "die_gds"
    inputs = {f"{block}.gds": f"{block}.gds" for block in (*BLOCKS, CORE)} | {"plan": "die_plan.plan"}
    outputs = {"gds": f"{TOP}.gds", "checked": "checked.gds"}
    metrics = {"rectangles": ""}
    tools = ("python klayout",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        import klayout.db as db

        plan, layout = json.loads(inputs["plan"].read_text()), db.Layout()
        tech = coriolis_platform(self.parameters.pdk)
        layout.dbu = 0.001
        top = layout.create_cell(TOP)
        cells = {name: layout.create_cell(block["cell"]) for name, block in plan["blocks"].items()}
        for name, block in plan["blocks"].items():
            source = db.Layout()
            source.read(str(inputs[f"{name}.gds"]))
            tops = [cell.name for cell in source.top_cells()]
            if tops != [block["cell"]]:
                has = f"{inputs[f'{name}.gds'].name} has the top cells {', '.join(tops)}"
                raise StepError(f"die_gds: {has}; its LEF is of {block['cell']}")
            cells[name].copy_tree(source.top_cell())  # renames cells in it whose name is taken
            top.insert(db.CellInstArray(cells[name].cell_index(), placed(block)))
        for _, layer, datatype, *box in plan["shapes"]:
            top.shapes(layout.layer(layer, datatype)).insert(db.Box(*box))
        for net, boxes in plan["pins"].items():
            for _, layer, _, *box in boxes:
                middle = db.Trans(db.Box(*box).center() - db.Point())
                for datatype in (tech.pin_datatype, tech.label_datatype):
                    top.shapes(layout.layer(layer, datatype)).insert(db.Text(net, middle))
        top.shapes(layout.layer(*tech.outline)).insert(db.Box(0, 0, *plan["die"]))
        write_gds(layout, outputs["gds"])
        for name in self.parameters.drawn:
            inner = [layout.cell(index) for index in cells[name].each_child_cell()]
            for cell in inner:
                if cell.name.startswith(PIXELS):
                    cell.prune_cell()
        write_gds(layout, outputs["checked"])
        return {"rectangles": len(plan["shapes"])}


def placed(block: Mapping[str, Any]) -> "kdb.Trans":
    """Transformation of a block of the plan."""
    import klayout.db as db

    left, bottom, right, top = block["box"]
    sideways, upright = ORIENTATIONS[block["orientation"]]
    turn = ((db.Trans.R0, db.Trans.M0), (db.Trans.M90, db.Trans.R180))[sideways][upright]
    return db.Trans(turn, right if sideways else left, top if upright else bottom)
