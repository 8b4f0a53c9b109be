"""The chip's timing with the die's wires at its ports."""

import re

from flow.layout.steps import sta
from flow.layout.steps.sta import Sta
from flow.layout.timing import opensta


class DieSta(Sta):
    """As `Sta`; slews_over: pins whose slew is longer than any at which the cells were measured (max_transition), where
    their delays are an extrapolation; worst_slew_ns: the longest of these."""

    inputs = {"verilog": "core.verilog", "spef": "core.spef", "sdc": "die_wires.sdc"}
    metrics = Sta.metrics | {"slews_over": "", "worst_slew_ns": "ns"}
    uses = (opensta, sta)

    def __init__(self, parameters):
        super().__init__(parameters)
        self.name = f"die_sta_{parameters.corner}"

    def run(self, inputs, outputs):
        found = super().run(inputs, outputs)
        slews = over(outputs["report"].read_text())
        return found | {"slews_over": len(slews), "worst_slew_ns": max(slews, default=None)}


def over(said):
    """ns of every slew over its limit, as OpenSTA's report ``said`` lists them."""
    _, _, part = said.partition("max_transition")
    return [float(slew) for slew in re.findall(r"^\S+\s+[\d.]+\s+([\d.]+)\s+-[\d.]+ \(VIOLATED\)", part, re.M)]
