"""Rows and columns of a block, the side on which each of its pins lies, and the places of blocks laid out before."""

import json
import math
from dataclasses import dataclass
from itertools import pairwise

from base.steps import Step, StepError
from models.parameters import ParameterError, check_real
from platforms.coriolis import coriolis_platform

from ..geometry import macro as macro_module
from ..geometry.macro import Macro
from ..netlist import netlist as netlist_module
from ..netlist.netlist import Netlist

SIDES = ("west", "east")  # the router gives up on some pins on the other two
CLOCK_CELLS_SHARE = 0.06  # of the cells' area, for the clock tree's buffers to come
BESIDE_UM = 15.0  # least width of rows beside a block: a strap of either supply must find a place there
TREE_ASPECT = 1.8  # Coriolis cuts a longer box in two halves, whose wires then lie on one another
HALO_ROWS = 3, 2  # heights of a row that are left free beside a block, where its pins are met, and above it


@dataclass(frozen=True)
class FloorplanParameters:
    """pdk: process. utilization: cells' area by core area without the blocks. aspect: width by height. macros: blocks
    laid out before: (instance, module, share of the width, share of the height that are free to its west and south).
    """

    pdk: str = "sky130"
    utilization: float = 0.5
    aspect: float = 1.0
    macros: tuple = ()

    def __post_init__(self):
        check_real("utilization", self.utilization, 0.05, 0.95)
        check_real("aspect", self.aspect, 0.2, 5.0)
        for instance, _, *at in self.macros:
            for share in at:
                check_real(f"macros of {instance}", share, 0.0, 1.0)


class Floorplan(Step):
    """As square as ``aspect`` says; the pins in the order of the ports, on the west and the east, buses together.

    Around a block there are no cells, HALO_ROWS wide. tree: the largest box without blocks, in which the clock's tree
    is built.
    """

    name = "floorplan"
    inputs = {"netlist": "synthesis.netlist", "areas": "library.areas", "geometry": "library.geometry"}
    outputs = {"floorplan": "floorplan.json"}
    Parameters = FloorplanParameters
    metrics = {
        "rows": "",
        "columns": "",
        "width_um": "um",
        "height_um": "um",
        "core_area_um2": "um2",
        "macro_area_um2": "um2",
    }
    uses = (macro_module, netlist_module)

    def __init__(self, parameters):
        super().__init__(parameters)
        self.inputs = self.inputs | {module: f"macro.{module}.lef" for _, module, *_ in parameters.macros}

    def run(self, inputs, outputs):
        p = self.parameters
        known = coriolis_platform(p.pdk)
        netlist, areas = Netlist.read(inputs["netlist"]), json.loads(inputs["areas"].read_text())
        macros = [(name, Macro.read(inputs[module], known), at) for name, module, *at in p.macros]
        modules = {macro.name for _, macro, _ in macros}
        unknown = sorted({i.cell for i in netlist.instances} - set(areas) - modules)
        if unknown:
            raise StepError(
                f"floorplan: no layout of the cells {', '.join(unknown[:5])}: LIBERTY must be of the cells "
                "that are laid out"
            )
        lost = {i.name for i in netlist.instances if i.cell in modules} ^ {name for name, *_ in macros}
        if lost:
            raise StepError(
                f"floorplan: the places given for blocks and the blocks in the Verilog differ by "
                f"{', '.join(sorted(lost))}"
            )
        above = HALO_ROWS[1] * known.row_um
        blocks = sum(_with_halo(macro, known) * (macro.height_um + above) for _, macro, _ in macros)
        area = blocks + (sum(areas.get(i.cell, 0) for i in netlist.instances) * (1 + CLOCK_CELLS_SHARE) / p.utilization)
        rows = max(4, 2 * round(math.sqrt(area / p.aspect) / known.row_um / 2))  # even: the top rail is ground too
        columns = math.ceil(area / (rows * known.row_um) / known.site_um)
        made = {
            "rows": rows,
            "columns": columns,
            "width_um": round(columns * known.site_um, 4),
            "height_um": round(rows * known.row_um, 4),
            "pins": pins(netlist.ports),
        }
        made["macros"] = placed(macros, made["width_um"], made["height_um"], known)
        made["tree"] = free(made)
        outputs["floorplan"].write_text(json.dumps(made, indent=1))
        return {
            "core_area_um2": round(made["width_um"] * made["height_um"], 2),
            "macro_area_um2": round(sum(macro.width_um * macro.height_um for _, macro, _ in macros), 2),
            **{name: made[name] for name in ("rows", "columns", "width_um", "height_um")},
        }


def pins(ports):
    """dict side -> nets of the pins on it."""
    nets = [net for port in sorted(ports, key=lambda port: port.direction) for net in port.bits()]
    share = math.ceil(len(nets) / len(SIDES))
    return {side: nets[k * share : (k + 1) * share] for k, side in enumerate(SIDES)}


def _with_halo(macro, known):
    """Width (um) of a block and of what is left free on both sides, a multiple of a row's height, as the router's cells
    are: a pin in one that is half taken is met badly."""
    return round(math.ceil(macro.width_um / known.row_um + 2 * HALO_ROWS[0] - 1e-9) * known.row_um, 4)


def placed(macros, width, height, known):
    """List of dicts: instance, cell, x_um, y_um, width_um, height_um, and outer, the box (um) with what is left free.

    Raises ParameterError where blocks meet, or lie above one another: their straps go on through the whole core.
    """
    made, row = [], known.row_um
    for name, macro, (across, along) in macros:
        wide = _with_halo(macro, known)
        left = round(across * (width - wide) / row) * row
        bottom = round(along * (height - macro.height_um) / row / 2) * 2 * row  # even: rails in line with rows'
        top = bottom + macro.height_um
        if left < 0 or bottom < 0 or top > height + 1e-6:
            raise ParameterError(
                f"utilization: {name} of {macro.width_um} x {macro.height_um} um does not fit into "
                f"{width} x {height} um"
            )
        beside, above = (rows * row for rows in HALO_ROWS)
        outer = left, max(0, bottom - above), left + wide, min(height, top + above)
        made.append(
            {
                "instance": name,
                "cell": macro.name,
                "x_um": round(left + beside, 4),
                "y_um": round(bottom, 4),
                "width_um": macro.width_um,
                "height_um": macro.height_um,
                "outer": [round(value, 4) for value in outer],
            }
        )
    ends = sorted((block["outer"][0], block["outer"][2], block["instance"]) for block in made)
    edges = [(0, 0, "the west edge"), *ends, (width, 0, "the east edge")]
    for (_, end, name), (begin, _, other) in pairwise(edges):
        if begin - end < BESIDE_UM:
            raise ParameterError(f"macros = {name}: must be {BESIDE_UM:g} um west of {other}, not {begin - end:.1f} um")
    return made


def free(plan):
    """The largest box [left, bottom, right, top] of the core that no block's outer box meets, none longer than
    TREE_ASPECT times its other side."""
    outer = [block["outer"] for block in plan["macros"]]
    x = sorted({0.0, plan["width_um"], *(v for box in outer for v in (box[0], box[2]))})
    y = sorted({0.0, plan["height_um"], *(v for box in outer for v in (box[1], box[3]))})
    boxes = [
        _shorter(a, b, c, d)
        for a in x
        for c in x
        if c > a
        for b in y
        for d in y
        if d > b
        if not any(a < o[2] and o[0] < c and b < o[3] and o[1] < d for o in outer)
    ]
    return max(boxes, key=lambda box: (box[2] - box[0]) * (box[3] - box[1]))


def _shorter(left, bottom, right, top):
    """The box with its longer side cut, alike at both ends."""
    across = max(0, right - left - TREE_ASPECT * (top - bottom)) / 2
    along = max(0, top - bottom - TREE_ASPECT * (right - left)) / 2
    return [round(v, 1) for v in (left + across, bottom + along, right - across, top - along)]
