"""The die: planned and routed, drawn, compared with its nets."""

import json
from dataclasses import asdict, dataclass, field

from flow.gds import write_gds
from flow.layout.macro import Macro, layer_names
from flow.layout.mend import wiring as wiring_module
from flow.layout.mend.wiring import Wiring
from flow.platforms import openroad
from flow.platforms.die import thick
from flow.platforms.embedded import process
from flow.steps import Step, StepError

from . import channel, connectivity, plan, routing, shapes, verilog
from .plan import BLOCKS, CORE, Block, DieParameters, nm

TOP = "asp_sensor"


@dataclass(frozen=True)
class DiePlanParameters:
    """pdk: process. die: sizes. extra: pins of analog blocks that lead to pins of the die."""

    pdk: str = "sky130"
    die: DieParameters = field(default_factory=DieParameters)
    extra: tuple = ()


class DiePlan(Step):
    """Places from the LEFs alone; wires in one channel below all blocks; supplies on the thick wire.

    tracks: of the channel. wire_um: of the signals. abutted: nets whose pins touch.
    """

    name = "die_plan"
    inputs = {f"{block}.lef": f"{block}.lef" for block in (*BLOCKS, CORE)} | {
        "rules": "library.rules", "platform": "platform", "thick": "thick"}
    outputs = {"plan": "plan.json", "verilog": f"{TOP}.v"}
    Parameters = DiePlanParameters
    metrics = {"area_um2": "um2", "utilization": "", "nets": "", "routed": "", "abutted": "", "tracks": "",
               "wire_um": "um"}
    uses = (channel, plan, routing, shapes, verilog, wiring_module)

    def run(self, inputs, outputs):
        known, _ = process(self.parameters.pdk)
        die, wiring = self.parameters.die, Wiring.of(known, json.loads(inputs["rules"].read_text()))
        tracks, names = routing.Tracks.of(wiring), layer_names(self.parameters.pdk)
        layers = [names.get((wire.layer, wire.datatype), wire.name)
                  for wire in (wiring.layers[routing.STUB], wiring.layers[routing.VERTICAL])]
        blocks = {name: Block.read(name, inputs[f"{name}.lef"].read_text()) for name in (*BLOCKS, CORE)}
        straps = [(net, nm(x)) for net, x in Macro.read(inputs[f"{CORE}.lef"], known, names).straps]
        core, begin = blocks.pop(CORE), nm(die.edge_um + die.gap_um)
        room, placed = routing.side_room(core, tracks), plan.stack(blocks, die)
        low = plan.with_core(placed, core, die, room, 0)
        nets = plan.nets(low, self.parameters.extra)
        routed, abutted = routing.joined(low, nets)
        made = routing.reaches(low, routed, die, tracks, layers)
        lanes = routing.trunks(made, tracks)
        height = begin + (max(lanes.values()) + 1) * tracks.trunk_pitch + nm(die.gap_um)
        blocks, made = plan.with_core(placed, core, die, room, height), routing.raised(made, height)
        y = {net: begin + track * tracks.trunk_pitch for net, track in lanes.items()}
        metal, pins = shapes.supplies(blocks, straps, die, wiring, thick(self.parameters.pdk))
        for net, found in made.items():
            metal += shapes.signal(net, found, y[net], tracks, wiring)
        pads = {net: [shapes.pad(reach, die, tracks, wiring) for reach in found if reach.block == "die"]
                for net, found in made.items()}
        above = thick(self.parameters.pdk).wire
        pads = {net: found for net, found in pads.items() if found} | {
            net: [shapes.drawn(above, net, *box) for box in boxes] for net, boxes in pins.items()}
        area = die.width_um * die.height_um
        outputs["plan"].write_text(json.dumps({
            "die": [nm(die.width_um), nm(die.height_um)],
            "blocks": {name: {"cell": block.cell, "box": block.box} for name, block in blocks.items()},
            "nets": nets, "drivers": {net: plan.driver(blocks, ends) for net, ends in routed.items()}, "channel": [begin, height], "tracks": asdict(tracks),
            "pins": {net: [_plain(shape) for shape in found] for net, found in pads.items()},
            "shapes": [_plain(shape) for shape in metal],
            "routes": {net: {"y": y[net], "reaches": [asdict(reach) for reach in found]}
                       for net, found in made.items()}}) + "\n")
        outputs["verilog"].write_text(verilog.top(TOP, blocks, nets))
        return {"area_um2": area, "utilization": round(sum(b.width * b.height for b in blocks.values()) / area / 1e6, 4),
                "nets": len(nets), "routed": len(routed), "abutted": len(abutted), "tracks": max(lanes.values()) + 1,
                "wire_um": round(sum(routing.length(found, y[net]) for net, found in made.items()) / 1000, 1)}


def _plain(shape):
    return [shape.net, shape.layer, shape.datatype, *shape.box]


@dataclass(frozen=True)
class DieParametersOfGds:
    """pdk: process."""

    pdk: str = "sky130"


class DieGds(Step):
    """The blocks' GDS where the plan has them, and its metal."""

    name = "die_gds"
    inputs = {f"{block}.gds": f"{block}.gds" for block in (*BLOCKS, CORE)} | {
        "plan": "die_plan.plan", "platform": "platform"}
    outputs = {"gds": f"{TOP}.gds"}
    Parameters = DieParametersOfGds
    metrics = {"rectangles": ""}
    tools = ("python klayout",)

    def run(self, inputs, outputs):
        import klayout.db as db
        made, layout = json.loads(inputs["plan"].read_text()), db.Layout()
        known, _ = process(self.parameters.pdk)
        layout.dbu = 0.001
        top = layout.create_cell(TOP)
        options = db.LoadLayoutOptions()
        options.cell_conflict_resolution = db.LoadLayoutOptions.CellConflictResolution.RenameCell
        for name, block in made["blocks"].items():
            before = {cell.cell_index() for cell in layout.top_cells()}
            layout.read(str(inputs[f"{name}.gds"]), options)
            new = [cell for cell in layout.top_cells() if cell.cell_index() not in before]
            if [cell.name for cell in new] != [block["cell"]]:
                raise StepError(f"die_gds: {inputs[f'{name}.gds'].name} has the top cells "
                                f"{', '.join(cell.name for cell in new)}; its LEF is of {block['cell']}")
            top.insert(db.CellInstArray(new[0].cell_index(), db.Trans(*block["box"][:2])))
        for _, layer, datatype, *box in made["shapes"]:
            top.shapes(layout.layer(layer, datatype)).insert(db.Box(*box))
        for net, boxes in made["pins"].items():
            for _, layer, datatype, *box in boxes:
                for of in (known.pin_datatype, known.label_datatype):
                    top.shapes(layout.layer(layer, of)).insert(db.Text(net, db.Trans(db.Box(*box).center() - db.Point())))
        outline = openroad.process(self.parameters.pdk).outline
        top.shapes(layout.layer(*outline)).insert(db.Box(0, 0, *made["die"]))
        write_gds(layout, outputs["gds"])
        return {"rectangles": len(made["shapes"])}


class DieMatch(Step):
    """Every net of the plan, found again in the metal of the finished GDS and of the blocks in it.

    lvs_match: of blocks, whose insides are those of their own checks.
    """

    name = "die_match"
    inputs = {"gds": "die_gds.gds", "plan": "die_plan.plan", "platform": "platform", "thick": "thick"}
    outputs = {"report": "connectivity.json"}
    Parameters = DieParametersOfGds
    metrics = {"open_nets": "", "shorts": "", "lvs_match": ""}
    uses = (connectivity,)
    tools = ("python klayout",)

    def run(self, inputs, outputs):
        made = json.loads(inputs["plan"].read_text())
        cells = {block["cell"]: name for name, block in made["blocks"].items()}
        found = connectivity.nets(inputs["gds"], cells, process(self.parameters.pdk)[0], thick(self.parameters.pdk))
        opens, shorts = connectivity.compare(found, made["nets"])
        outputs["report"].write_text(json.dumps({"open": opens, "short": shorts}, indent=1) + "\n")
        return {"open_nets": len(opens), "shorts": len(shorts), "lvs_match": not opens and not shorts}
