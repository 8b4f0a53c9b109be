"""Rows and columns of a block, and the side on which each of its pins lies."""

import json
import math
from dataclasses import dataclass, field

from flow.steps import Step, StepError
from models.parameters import check_real

from ..netlist import Netlist

SIDES = ("west", "east")          # the router gives up on some pins on the other two
CLOCK_CELLS_SHARE = 0.06        # of the cells' area, for the clock tree's buffers to come


@dataclass(frozen=True)
class FloorplanParameters:
    """utilization: cells' area by core area. aspect: width by height. row_um, site_um: the process's."""

    utilization: float = 0.5
    aspect: float = 1.0
    row_um: float = field(default=5.6, metadata={"unit": "um"})
    site_um: float = field(default=0.8, metadata={"unit": "um"})

    def __post_init__(self):
        check_real("utilization", self.utilization, 0.05, 0.95)
        check_real("aspect", self.aspect, 0.2, 5.0)


class Floorplan(Step):
    """As square as ``aspect`` says; the pins in the order of the ports, on the west and the east, buses together."""

    name = "floorplan"
    inputs = {"netlist": "synthesis.netlist", "areas": "library.areas"}
    outputs = {"floorplan": "floorplan.json"}
    Parameters = FloorplanParameters
    metrics = {"rows": "", "columns": "", "width_um": "um", "height_um": "um", "core_area_um2": "um2"}

    def run(self, inputs, outputs):
        p = self.parameters
        netlist, areas = Netlist.read(inputs["netlist"]), json.loads(inputs["areas"].read_text())
        unknown = sorted({i.cell for i in netlist.instances} - set(areas))
        if unknown:
            raise StepError(f"floorplan: no layout of the cells {', '.join(unknown[:5])}: LIBERTY must be of the cells "
                            "that are laid out")
        area = sum(areas[i.cell] for i in netlist.instances) * (1 + CLOCK_CELLS_SHARE) / p.utilization
        rows = max(4, 2 * round(math.sqrt(area / p.aspect) / p.row_um / 2))     # even: the top rail is ground too
        columns = math.ceil(area / (rows * p.row_um) / p.site_um)
        made = {"rows": rows, "columns": columns, "width_um": round(columns * p.site_um, 4),
                "height_um": round(rows * p.row_um, 4), "pins": pins(netlist.ports)}
        outputs["floorplan"].write_text(json.dumps(made, indent=1))
        return {"core_area_um2": round(made["width_um"] * made["height_um"], 2),
                **{name: made[name] for name in ("rows", "columns", "width_um", "height_um")}}


def pins(ports):
    """dict side -> nets of the pins on it."""
    nets = [net for port in sorted(ports, key=lambda port: port.direction) for net in port.bits()]
    share = math.ceil(len(nets) / len(SIDES))
    return {side: nets[k * share:(k + 1) * share] for k, side in enumerate(SIDES)}
