"""Antennas of the die's wires, before a net is whole."""

import json
from dataclasses import replace

from flow.layout.steps import antenna
from flow.layout.steps.antenna import Antenna, violations
from flow.platforms.embedded import process

from .routing import VERTICAL


class DieAntenna(Antenna):
    """As `Antenna`, of the whole die, for the wires below the verticals: up to these, a gate of the chip has nothing of
    the die but what lies at its pin. With them comes the net's driver, whose diffusion a frame does not have."""

    name = "die_antenna"
    inputs = {"gds": "die_gds.gds", "platform": "platform"}
    uses = (antenna,)

    def run(self, inputs, outputs):
        import klayout.db as db
        known, _ = process(self.parameters.pdk)
        below = replace(known, wires=known.wires[:VERTICAL], cuts=known.cuts[:VERTICAL - 1])
        layout = db.Layout()
        layout.read(str(inputs["gds"]))
        found = {below.wires[level].name: sorted({str(polygon.bbox().to_dtype(layout.dbu)) for polygon in bad.each()})
                 for level, bad in violations(layout, layout.top_cell(), below).items()}
        outputs["summary"].write_text(json.dumps(found, indent=1) + "\n")
        return {"antenna_violations": sum(map(len, found.values()))}
