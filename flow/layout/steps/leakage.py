"""Leakage of a layout at every corner, from the cells' Liberty."""

import json
from collections import Counter
from dataclasses import dataclass
from typing import Any

from talbot.base.liberty.read import read
from talbot.base.steps import Files, Step
from talbot.flow.layout.power.energy import Cells
from talbot.signoff.netlist.netlist import Netlist


@dataclass(frozen=True)
class LeakageParameters:
    """The corners of the cells."""

    corners: tuple[str, ...] = ()


class Leakage(Step[LeakageParameters]):
    """Sum over all cells of the mean of each cell's states; a cell without Liberty (tie, diode) counts as 0.

    kinds: uW by kind of cell and corner.
    """

    name = "leakage"
    outputs = {"kinds": "leakage.json"}
    metrics = {"leakage_uw": "uW"}

    def __init__(self, parameters: LeakageParameters) -> None:
        super().__init__(parameters)
        corners = parameters.corners
        self.inputs = {"netlist": "stream_out.netlist"} | {corner: f"timing.{corner}" for corner in corners}

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        count = Counter(instance.cell for instance in Netlist.read(inputs["netlist"]).instances)
        kinds: dict[str, dict[str, float]] = {}
        for corner in self.parameters.corners:
            cells = Cells(read(inputs[corner]))
            leakage = {cell: number * cells.leakage_nw(cell) / 1000 for cell, number in count.items()}
            kinds[corner] = {cell: round(uw, 6) for cell, uw in sorted(leakage.items(), key=lambda x: -x[1])}
        outputs["kinds"].write_text(json.dumps(kinds, indent=1) + "\n", encoding="utf-8")
        return {"leakage_uw": {corner: round(sum(by_cell.values()), 4) for corner, by_cell in kinds.items()}}
