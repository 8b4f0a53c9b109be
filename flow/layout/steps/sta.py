"""Static timing at one corner, with the parasitics, in OpenSTA."""

import re
from dataclasses import dataclass
from typing import Any

from talbot.base.steps import Files
from talbot.flow.layout.steps.corner import CornerStep
from talbot.flow.layout.timing.opensta import TIMED, opensta, worst_slack

SCRIPT = (
    TIMED
    + """
puts "WORST setup [worst_slack -max]"
puts "WORST hold [worst_slack -min]"
report_checks -path_delay max -fields {{slew capacitance net}} -digits 4
report_checks -path_delay min -fields {{slew capacitance net}} -digits 4
report_check_types -violators
write_sdf -digits 4 -no_timestamp {sdf}
"""
)
LIMITS = {"max_transition": "slew_violations", "max_capacitance": "capacitance_violations"}  # OpenSTA's: ours


@dataclass(frozen=True)
class StaParameters:
    """What is timed. top: module. corner: its name in the reports. period_ns: of the clock."""

    top: str = ""
    corner: str = ""
    period_ns: float = 0.0


class Sta(CornerStep[StaParameters]):
    """Slacks, and an SDF of all delays.

    wns_ns, whs_ns: worst slack of setup and hold. f_max_mhz: clock at which the setup slack is 0, with the same I/O
    delays in ns. slew_violations, capacitance_violations: pins beyond what the cells were characterized for.
    """

    name = "sta_{corner}"
    inputs = {"verilog": "stream_out.verilog", "spef": "extraction.{wires}", "sdc": "sdc", "liberty": "timing.{corner}"}
    outputs = {"report": "sta.txt", "sdf": "delays.sdf"}
    metrics = {"wns_ns": "ns", "whs_ns": "ns", "f_max_mhz": "MHz", **dict.fromkeys(LIMITS.values(), "")}
    tools = ("openroad",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        script = SCRIPT.format(top=self.parameters.top, sdf=outputs["sdf"], **inputs)
        report = opensta(outputs["report"].with_name("sta.log"), script)
        outputs["report"].write_text(report, encoding="utf-8")
        setup, hold = (worst_slack(report, kind) for kind in ("setup", "hold"))
        f_max = round(1000 / (self.parameters.period_ns - setup), 2)
        slacks = {"wns_ns": round(setup, 4), "whs_ns": round(hold, 4)}
        return slacks | {"f_max_mhz": f_max} | beyond_limits(report)


def beyond_limits(report: str) -> dict[str, int]:
    """How many pins are beyond a limit of the Liberty, by the name of the metric, from OpenSTA's output of SCRIPT."""
    sections = re.split(r"(?m)^(max_\w+)$", report)
    found = dict(zip(sections[1::2], sections[2::2], strict=True))
    return {name: found.get(limit, "").count("(VIOLATED)") for limit, name in LIMITS.items()}
