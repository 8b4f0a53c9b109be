"""The loops of the extraction, compiled while other steps run."""

from typing import Any

import numpy as np

from talbot.base.gds import db
from talbot.base.steps import Files, Step
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.platforms.extraction import extraction_platform
from talbot.platforms.layout import layout_platform
from talbot.signoff.parasitics.capacitance import capacitances
from talbot.signoff.parasitics.extract import floating, with_fill_floating
from talbot.signoff.parasitics.shapes import METAL_LEVEL, shapes
from talbot.signoff.parasitics.trees import trees

HALF_NM, ENDS_NM = 150, ((5_000, 5_000), (25_000, 20_000))  # half the width of a segment; where the net's ends are


class Compiled(Step[PdkParameters]):
    """A net is extracted: Numba then has in its cache what `extraction` calls. There is no result."""

    name = "compiled"
    shared = True
    tools = ("python klayout",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        tech, devices = layout_platform(self.parameters.pdk), extraction_platform(self.parameters.pdk)
        layout = db.Layout()
        drawn, (low, high), via = layout.create_cell("top"), tech.metals[1:3], tech.vias[1]
        (left, bottom), (right, top) = ENDS_NM
        for metal, box in ((low, db.Box(left, bottom, right, bottom)), (high, db.Box(right, bottom, right, top))):
            drawn.shapes(layout.layer(*metal.gds)).insert(box.enlarged(HALF_NM))
        drawn.shapes(layout.layer(*via.gds)).insert(db.Box(right, bottom, right, bottom).enlarged(HALF_NM // 2))
        found = shapes(layout, drawn, tech, devices)
        ends = [(found.at(METAL_LEVEL + k, *at), *at) for k, at in enumerate(ENDS_NM, 1)]
        floats = floating(found, np.array([found.nets[ends[0][0]]]))
        wires = list(tech.wires.values())
        own = with_fill_floating(found, capacitances(found, wires, floats)[0], floats)
        trees(found, own, wires[0], [devices.vias[0].lef, *(via.lef for via in tech.vias)], ends, [0])
        return {}
