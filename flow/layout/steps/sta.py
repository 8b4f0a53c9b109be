"""Static timing at one corner, with the parasitics, in OpenSTA."""

import re
from dataclasses import dataclass
from typing import Any

from base.steps import Files, StepError

from ..timing.opensta import opensta
from .corner import CornerStep

SCRIPT = """
read_liberty {liberty}
read_verilog {verilog}
link_design {top}
source {sdc}
read_spef {spef}
puts "WORST setup [worst_slack -max]"
puts "WORST hold [worst_slack -min]"
report_checks -path_delay max -fields {{slew capacitance net}} -digits 4
report_checks -path_delay min -fields {{slew capacitance net}} -digits 4
report_check_types -all_violators
write_sdf -digits 4 -no_timestamp {sdf}
"""


@dataclass(frozen=True)
class StaParameters:
    """What is timed. top: module. corner: its name in the reports. period_ns: of the clock."""

    top: str = ""
    corner: str = ""
    period_ns: float = 0.0


class Sta(CornerStep[StaParameters]):
    """Slacks, and an SDF of all delays.

    wns_ns, whs_ns: worst slack of setup and hold. f_max_mhz: clock at which the setup slack is 0, with the same I/O
    delays in ns.
    """

    name = "sta_{corner}"
    inputs = {"verilog": "stream_out.verilog", "spef": "extraction.{wires}", "sdc": "sdc", "liberty": "timing.{corner}"}
    outputs = {"report": "sta.txt", "sdf": "delays.sdf"}
    metrics = {"wns_ns": "ns", "whs_ns": "ns", "f_max_mhz": "MHz"}
    tools = ("sta",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        script = SCRIPT.format(top=self.parameters.top, sdf=outputs["sdf"], **inputs)
        report = opensta(outputs["report"].with_name("sta.log"), script)
        outputs["report"].write_text(report)
        worst = worst_slacks(report, "sta")
        f_max = round(1000 / (self.parameters.period_ns - worst["setup"]), 2)
        return {"wns_ns": round(worst["setup"], 4), "whs_ns": round(worst["hold"], 4), "f_max_mhz": f_max}


def worst_slacks(report: str, step: str) -> dict[str, float]:
    """Slacks (ns) of 'setup' and 'hold' from OpenSTA's output of SCRIPT. Raises StepError in the name of ``step``."""
    worst = {kind: float(value) for kind, value in re.findall(r"WORST (\w+) (\S+)", report)}
    if set(worst) != {"setup", "hold"}:
        raise StepError(f"{step}: OpenSTA: no slack")
    return worst
