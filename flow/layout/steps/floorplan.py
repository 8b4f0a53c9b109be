"""Rows and columns of a block, the side of each of its pins, and the places of its macros."""

import json
import math
from dataclasses import dataclass
from typing import Any

from talbot.base.steps import Files, Step, StepError
from talbot.models.parameters import ParameterError, check_real
from talbot.platforms.coriolis import coriolis_platform

from ..geometry.floorplan import framed, halo_area, largest_free, place_macros
from ..geometry.macro import Macro
from ..netlist.netlist import Netlist
from ..netlist.pins import pins

AREAS = ("core_area_um2", "macro_area_um2")
CLOCK_CELLS_SHARE = 0.06  # of the cells' area, for the clock tree's buffers to come


@dataclass(frozen=True)
class FloorplanParameters:
    """Parameters of `Floorplan`.

    pdk: process. utilization: cells' area by core area without the macros. aspect: width by height.
    macros: (instance, module, share of the width, share of the height that are free to its west and south).
    frame: of the process; it decides in place of utilization, here the most, and aspect.
    """

    pdk: str = "sky130"
    utilization: float = 0.5
    aspect: float = 1.0
    macros: tuple[tuple[str, str, float, float], ...] = ()
    frame: str = ""

    def __post_init__(self) -> None:
        check_real("utilization", self.utilization, 0.05, 0.95)
        check_real("aspect", self.aspect, 0.2, 5.0)
        for instance, _, *at in self.macros:
            for share in at:
                check_real(f"macros of {instance}", share, 0.0, 1.0)


class Floorplan(Step[FloorplanParameters]):
    """A core of the given ``aspect``; the pins in the order of the ports, on the west and the east, buses together.

    In a frame, the largest core that fits, and the frame's ports: frame has its box, ports theirs, (net, metal, box),
    in um from the core's origin. Around a macro there are no cells. tree: the largest box without macros, in which the
    clock tree is built.
    """

    name = "floorplan"
    inputs = {"netlist": "synthesis.netlist", "areas": "library.areas", "geometry": "library.geometry"}
    outputs = {"floorplan": "floorplan.json"}
    metrics = {"rows": "", "columns": "", "width_um": "um", "height_um": "um", **dict.fromkeys(AREAS, "um2")}
    metrics |= {"utilization": ""}

    def __init__(self, parameters: FloorplanParameters) -> None:
        super().__init__(parameters)
        self.inputs = {**self.inputs, **{module: f"macro.{module}.lef" for _, module, *_ in parameters.macros}}

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        p, tech = self.parameters, coriolis_platform(self.parameters.pdk)
        netlist, areas = Netlist.read(inputs["netlist"]), json.loads(inputs["areas"].read_text(encoding="utf-8"))
        macros = [(name, Macro.read(inputs[module], tech), (x, y)) for name, module, x, y in p.macros]
        self.check(netlist, areas, {name: macro.name for name, macro, _ in macros})
        cells = sum(areas.get(i.cell, 0) for i in netlist.instances) * (1 + CLOCK_CELLS_SHARE)
        area = sum(halo_area(macro, tech) for _, macro, _ in macros) + cells / p.utilization
        rows = max(4, 2 * round(math.sqrt(area / p.aspect) / tech.row_um / 2))  # even: the top rail is ground too
        columns = math.ceil(area / (rows * tech.row_um) / tech.site_um)
        utilization, given = p.utilization, dict[str, Any]()
        if p.frame:
            frame = tech.frame(p.frame)
            columns, rows, origin = frame.core(tech.site_um, tech.row_um)
            utilization = round(cells / (columns * tech.site_um * rows * tech.row_um), 4)
            if utilization > p.utilization:
                most = f"must be at most {p.utilization:g}"
                raise ParameterError(f"utilization = {utilization:g} of the frame {p.frame}: {most}")
            given = framed(frame, origin, netlist, tech)
        width, height = round(columns * tech.site_um, 4), round(rows * tech.row_um, 4)
        placed = place_macros(macros, width, height, tech)
        size = {"rows": rows, "columns": columns, "width_um": width, "height_um": height}
        tree = largest_free(width, height, [macro["outer"] for macro in placed])
        plan = size | {"pins": pins(netlist.ports), "macros": placed, "tree": tree} | given
        outputs["floorplan"].write_text(json.dumps(plan, indent=1), encoding="utf-8")
        inside = sum(macro.width_um * macro.height_um for _, macro, _ in macros)
        areas_um2 = dict(zip(AREAS, (round(width * height, 2), round(inside, 2)), strict=True))
        return size | areas_um2 | {"utilization": utilization}

    def check(self, netlist: Netlist, areas: dict[str, float], macros: dict[str, str]) -> None:
        """Raise StepError unless all cells have a layout and ``macros`` (cell by instance) are those in the netlist."""
        modules = set(macros.values())
        if unknown := sorted({i.cell for i in netlist.instances} - set(areas) - modules):
            cells = ", ".join(unknown[:5])
            raise StepError(
                f"floorplan: no layout of the cells {cells}: LIBERTY must be of the cells that are laid out"
            )
        if lost := {i.name for i in netlist.instances if i.cell in modules} ^ set(macros):
            names = ", ".join(sorted(lost))
            raise StepError(f"floorplan: the places given for macros and the macros in the Verilog differ by {names}")
