"""Static timing at one corner, with the parasitics, in OpenSTA."""

import re
from dataclasses import dataclass
from typing import Any

from talbot.base.steps import Files
from talbot.flow.layout.steps.corner import CornerStep
from talbot.flow.layout.timing.opensta import TIMED, opensta, worst_slack
from talbot.platforms.wires import CORNERS, wire_corner

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
OTHER = """
read_spef {spef}
puts "WORST setup.{wires} [worst_slack -max]"
puts "WORST hold.{wires} [worst_slack -min]"
"""
LIMITS = {"slew": "slew_violations", "capacitance": "capacitance_violations"}  # OpenSTA's: ours


@dataclass(frozen=True)
class StaParameters:
    """What is timed. top: module. corner: its name in the reports. period_ns: of the clock."""

    top: str = ""
    corner: str = ""
    period_ns: float = 0.0


class Sta(CornerStep[StaParameters]):
    """Slacks, and an SDF of all delays.

    wns_ns, whs_ns: worst slack of setup and hold over all corners of the wires. hold_by_wires_ns: hold at each of them.
    f_max_mhz: clock at which the setup slack is 0, with the same I/O delays in ns. slew_violations,
    capacitance_violations: pins beyond what the cells were characterized for. The report, these and the SDF are of the
    corner of wires that goes with the cells'.
    """

    name = "sta_{corner}"
    inputs = {"verilog": "stream_out.verilog", "spef": "extraction.{wires}", "sdc": "sdc", "liberty": "timing.{corner}"}
    inputs |= {wires: f"extraction.{wires}" for wires in CORNERS}
    outputs = {"report": "sta.txt", "sdf": "delays.sdf"}
    metrics = {"wns_ns": "ns", "whs_ns": "ns", "hold_by_wires_ns": "ns", "f_max_mhz": "MHz"}
    metrics |= dict.fromkeys(LIMITS.values(), "")
    tools = ("openroad",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        script = SCRIPT.format(top=self.parameters.top, sdf=outputs["sdf"], **inputs)
        matching = wire_corner(self.parameters.corner)
        others = [wires for wires in CORNERS if wires != matching]
        script += "".join(OTHER.format(wires=wires, spef=inputs[wires]) for wires in others)
        report = opensta(outputs["report"].with_name("sta.log"), script)
        outputs["report"].write_text(report, encoding="utf-8")
        slacks = {
            kind: {matching: worst_slack(report, kind)}
            | {wires: worst_slack(report, f"{kind}.{wires}") for wires in others}
            for kind in ("setup", "hold")
        }
        setup, hold = (min(by_wires.values()) for by_wires in slacks.values())
        f_max = round(1000 / (self.parameters.period_ns - setup), 2)
        hold_by_wires = {wires: round(slack, 4) for wires, slack in slacks["hold"].items()}
        figures = {"wns_ns": round(setup, 4), "whs_ns": round(hold, 4), "hold_by_wires_ns": hold_by_wires}
        return figures | {"f_max_mhz": f_max} | beyond_limits(report)


def beyond_limits(report: str) -> dict[str, int]:
    """How many pins are beyond a limit of the Liberty, by the name of the metric, from OpenSTA's output of SCRIPT."""
    return {name: section(report, limit).count("(VIOLATED)") for limit, name in LIMITS.items()}


def section(report: str, limit: str) -> str:
    """The pins beyond ``limit`` in OpenSTA's output, whose releases name it 'max slew' or 'max_slew'; '' for none."""
    _, *found = re.split(rf"(?m)^max[ _]{limit}$", report)
    return re.split(r"(?m)^max[ _]", found[0])[0] if found else ""
