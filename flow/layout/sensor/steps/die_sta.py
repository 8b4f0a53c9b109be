"""Static timing of the chip with the die's nets at its ports."""

import re
from typing import Any

from talbot.base.steps import Files
from talbot.flow.layout.steps.sta import Sta, section
from talbot.platforms.wires import CORNERS


class DieSta(Sta):
    """`Sta` of the chip on the die.

    slews_over: pins whose slew is beyond the cells' tables, where delays are extrapolated.
    worst_slew_ns: the longest of these.
    """

    name = "die_sta_{corner}"
    inputs = {**Sta.inputs, "verilog": "core.verilog", "spef": "core.{wires}", "sdc": "die_parasitics.sdc"}
    inputs |= {wires: f"core.{wires}" for wires in CORNERS}
    metrics = {**Sta.metrics, "slews_over": "", "worst_slew_ns": "ns"}

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        found = super().run(inputs, outputs)
        slews = over(outputs["report"].read_text(encoding="utf-8"))
        return found | {"slews_over": len(slews), "worst_slew_ns": max(slews, default=None)}


def over(report: str) -> list[float]:
    """Every slew (ns) over its limit in OpenSTA's report."""
    line = r"^\S+\s+[\d.]+\s+([\d.]+)\s+-[\d.]+ \(VIOLATED\)"
    return [float(slew) for slew in re.findall(line, section(report, "slew"), re.M)]
