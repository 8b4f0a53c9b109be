"""Design rules of a layout with a foundry's cells, by PDKMaster's deck."""

import json
import re
from typing import Any

from talbot.base.steps import Files
from talbot.flow.layout.steps import drc
from talbot.platforms.openroad import openroad_platform


class Drc(drc.Drc):
    """Rules of the metals and vias between them count; those of devices are counted apart, as `device_rules`.

    SkyWater's cells keep other rules in their devices (its core rules) than PDKMaster's deck has, and nothing is drawn
    there but the cells.
    """

    metrics = {"drc_violations": "", "device_rules": ""}

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        every = super().run(inputs, outputs)["drc_violations"]
        names = set(openroad_platform(self.parameters.pdk).deck_layers)
        found = json.loads(outputs["summary"].read_text(encoding="utf-8"))
        wiring = sum(
            count
            for rule, count in found.items()
            if not rule.startswith(drc.WARNING) and names & set(re.findall(r"\w+", rule))
        )
        return {"drc_violations": wiring, "device_rules": every - wiring}
