"""IR drop of the drawn array's supply."""

import json
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from talbot.base.steps import Files, Step
from talbot.flow.layout.sensor.array_drop import drops, mesh
from talbot.models.parameters import ArrayParameters
from talbot.platforms.die import top_metal
from talbot.platforms.layout import layout_platform


@dataclass(frozen=True)
class DieIrDropParameters:
    """Process, pixels. sink_a: of every column's follower, that of `make pixel-circuit`."""

    pdk: str = "sky130"
    array: ArrayParameters = field(default_factory=ArrayParameters)
    sink_a: float = field(default=5e-6, metadata={"unit": "A"})


class DieIrDrop(Step[DieIrDropParameters]):
    """Drop from the pads to the pixels of the row that is read, for rows over the array's height.

    pixel_drop_mv: the largest. pixel_spread_mv: the largest difference between two pixels of a row.
    pixel_drop_both_mv: the largest if the array were fed from the west as from the east.
    """

    name = "die_ir_drop"
    inputs = {"plan": "die_plan.plan"}
    outputs = {"rows": "rows.json"}
    metrics = {"pixel_drop_mv": "mV", "pixel_spread_mv": "mV", "pixel_drop_both_mv": "mV"}

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        p, array = self.parameters, self.parameters.array
        plan, tech = json.loads(inputs["plan"].read_text(encoding="utf-8")), layout_platform(p.pdk)
        made = mesh(plan, array, tech, top_metal(p.pdk))
        rows = (0, array.rows // 2, array.rows - 1)
        east, both = (1e3 * drops(made, array, rows, p.sink_a, sides) for sides in (False, True))
        mv = {row: np.round(own, 4).tolist() for row, own in zip(rows, east, strict=True)}
        outputs["rows"].write_text(json.dumps(mv) + "\n", encoding="utf-8")
        return {
            "pixel_drop_mv": round(float(east.max()), 3),
            "pixel_spread_mv": round(float(np.ptp(east, axis=1).max()), 3),
            "pixel_drop_both_mv": round(float(both.max()), 3),
        }
