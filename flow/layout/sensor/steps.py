"""The die: planned and routed, drawn, compared with its nets."""

import json
from dataclasses import asdict, dataclass, field

from base.gds import write_gds
from base.steps import Step, StepError
from flow.layout.reroute import rules as rules_module
from flow.layout.reroute.rules import RoutingRules
from platforms.coriolis import coriolis_platform
from platforms.die import top_metal

from . import arrange, channel, connectivity, plan, routing, shapes, supplies, verilog
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
    inputs = {f"{block}.lef": f"{block}.lef" for block in (*BLOCKS, CORE)} | {"rules": "library.rules"}
    outputs = {"plan": "plan.json", "verilog": f"{TOP}.v"}
    Parameters = DiePlanParameters
    metrics = {
        "area_um2": "um2",
        "utilization": "",
        "nets": "",
        "routed": "",
        "abutted": "",
        "tracks": "",
        "wire_um": "um",
    }
    uses = (arrange, channel, plan, routing, shapes, supplies, verilog, rules_module)

    def run(self, inputs, outputs):
        p, known = self.parameters, coriolis_platform(self.parameters.pdk)
        rules = RoutingRules.of(known, json.loads(inputs["rules"].read_text()))
        layers = [known.metals[level].lef for level in (routing.STUB, routing.VERTICAL)]
        blocks = {name: Block.read(name, inputs[f"{name}.lef"].read_text()) for name in (*BLOCKS, CORE)}
        tracks = routing.Tracks.of(rules)
        made = arrange.arranged(blocks, p.die, tracks, layers, p.extra)
        metal, pins = supplies.metal(made, p.die, tracks, rules, top_metal(p.pdk))
        outputs["plan"].write_text(json.dumps(described(made, metal, pins, p.die, tracks)) + "\n")
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


def described(made, metal, pins, die, tracks):
    """The plan as a dict for JSON, nm. made: Arranged; metal: list of Shape; pins: dict net -> those at the edge."""
    return {
        "die": [nm(die.width_um), nm(die.height_um)],
        "blocks": {
            name: {"cell": block.cell, "orientation": block.orientation, "box": block.box}
            for name, block in made.blocks.items()
        },
        "nets": made.nets,
        "drivers": {net: plan.driver(made.blocks, made.nets[net]) for net in made.routes},
        "channel": made.channel,
        "tracks": asdict(tracks),
        "pins": {net: [_plain(shape) for shape in found] for net, found in pins.items()},
        "shapes": [_plain(shape) for shape in metal],
        "routes": {
            net: {"y": made.y[net], "reaches": [asdict(reach) for reach in found]} for net, found in made.routes.items()
        },
    }


def _plain(shape):
    return [shape.net, shape.layer, shape.datatype, *shape.box]


@dataclass(frozen=True)
class DieGdsParameters:
    """pdk: process."""

    pdk: str = "sky130"


class DieGds(Step):
    """The blocks' GDS where the plan has them, and its metal."""

    name = "die_gds"
    inputs = {f"{block}.gds": f"{block}.gds" for block in (*BLOCKS, CORE)} | {"plan": "die_plan.plan"}
    outputs = {"gds": f"{TOP}.gds"}
    Parameters = DieGdsParameters
    metrics = {"rectangles": ""}
    tools = ("python klayout",)

    def run(self, inputs, outputs):
        import klayout.db as db

        made, layout = json.loads(inputs["plan"].read_text()), db.Layout()
        known = coriolis_platform(self.parameters.pdk)
        layout.dbu = 0.001
        top = layout.create_cell(TOP)
        cells = {name: layout.create_cell(block["cell"]) for name, block in made["blocks"].items()}
        for name, block in made["blocks"].items():
            source = db.Layout()
            source.read(str(inputs[f"{name}.gds"]))
            if [cell.name for cell in source.top_cells()] != [block["cell"]]:
                raise StepError(
                    f"die_gds: {inputs[f'{name}.gds'].name} has the top cells "
                    f"{', '.join(cell.name for cell in source.top_cells())}; its LEF is of {block['cell']}"
                )
            cells[name].copy_tree(source.top_cell())  # cells in it of a name that is taken get another
            top.insert(db.CellInstArray(cells[name].cell_index(), placed(block)))
        for _, layer, datatype, *box in made["shapes"]:
            top.shapes(layout.layer(layer, datatype)).insert(db.Box(*box))
        for net, boxes in made["pins"].items():
            for _, layer, datatype, *box in boxes:
                for of in (known.pin_datatype, known.label_datatype):
                    middle = db.Trans(db.Box(*box).center() - db.Point())
                    top.shapes(layout.layer(layer, of)).insert(db.Text(net, middle))
        outline = known.outline
        top.shapes(layout.layer(*outline)).insert(db.Box(0, 0, *made["die"]))
        write_gds(layout, outputs["gds"])
        return {"rectangles": len(made["shapes"])}


def placed(block):
    """klayout.db.Trans of a block of the plan."""
    import klayout.db as db

    left, bottom, right, top = block["box"]
    sideways, upright = plan.ORIENTATIONS[block["orientation"]]
    turn = {
        (False, False): db.Trans.R0,
        (True, False): db.Trans.M90,
        (False, True): db.Trans.M0,
        (True, True): db.Trans.R180,
    }[sideways, upright]
    return db.Trans(turn, right if sideways else left, top if upright else bottom)


class DieMatch(Step):
    """Every net of the plan, found again in the metal of the finished GDS and of the blocks in it.

    lvs_match: of blocks, whose insides are those of their own checks.
    """

    name = "die_match"
    inputs = {"gds": "die_gds.gds", "plan": "die_plan.plan"}
    outputs = {"report": "connectivity.json"}
    Parameters = DieGdsParameters
    metrics = {"open_nets": "", "shorts": "", "lvs_match": ""}
    uses = (connectivity,)
    tools = ("python klayout",)

    def run(self, inputs, outputs):
        made = json.loads(inputs["plan"].read_text())
        cells = {block["cell"]: name for name, block in made["blocks"].items()}
        found = connectivity.nets(
            inputs["gds"], cells, coriolis_platform(self.parameters.pdk), top_metal(self.parameters.pdk)
        )
        opens, shorts = connectivity.compare(found, made["nets"])
        outputs["report"].write_text(json.dumps({"open": opens, "short": shorts}, indent=1) + "\n")
        return {"open_nets": len(opens), "shorts": len(shorts), "lvs_match": not opens and not shorts}
