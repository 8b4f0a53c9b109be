"""Static timing at one corner, with the extracted wires: OpenSTA."""

import re
from dataclasses import dataclass

from base.steps import Step, StepError

from ..timing import opensta as opensta_module
from ..timing.opensta import opensta

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
    """top: module. corner: its name in the reports. period_ns: of the clock."""

    top: str = ""
    corner: str = ""
    period_ns: float = 0.0


class Sta(Step):
    """wns_ns, whs_ns: worst slack of setup and hold. f_max_mhz: of the clock at which the setup slack would be 0, the
    delays outside staying what they are."""

    inputs = {"verilog": "stream_out.verilog", "spef": "extraction.spef", "sdc": "sdc"}
    outputs = {"report": "sta.txt", "sdf": "delays.sdf"}
    Parameters = StaParameters
    metrics = {"wns_ns": "ns", "whs_ns": "ns", "f_max_mhz": "MHz"}
    uses = (opensta_module,)
    tools = ("sta",)

    def __init__(self, parameters):
        super().__init__(parameters)
        self.name = f"sta_{parameters.corner}"
        self.inputs = self.inputs | {"liberty": f"timing.{parameters.corner}"}

    def run(self, inputs, outputs):
        p = self.parameters
        said = opensta(outputs["report"].with_name("sta.log"), SCRIPT.format(top=p.top, sdf=outputs["sdf"], **inputs))
        outputs["report"].write_text(said)
        worst = worst_slacks(said, "sta")
        return {
            "wns_ns": round(worst["setup"], 4),
            "whs_ns": round(worst["hold"], 4),
            "f_max_mhz": round(1000 / (p.period_ns - worst["setup"]), 2),
        }


def worst_slacks(said, step):
    """dict 'setup' and 'hold' -> ns, from what OpenSTA ``said`` of SCRIPT. Raises StepError in the name of ``step``."""
    worst = {kind: float(value) for kind, value in re.findall(r"WORST (\w+) (\S+)", said)}
    if set(worst) != {"setup", "hold"}:
        raise StepError(f"{step}: OpenSTA: no slack")
    return worst
