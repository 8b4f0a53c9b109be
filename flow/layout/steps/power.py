"""Power at one corner from the transitions of the netlist in its recorded trace, split by block and by kind."""

import json
import re
from dataclasses import dataclass, field
from typing import Any

from talbot.base.liberty.read import read
from talbot.base.steps import Files
from talbot.flow.layout.power.energy import Cells, blocks, powers
from talbot.flow.layout.steps.corner import CornerStep
from talbot.flow.layout.timing.opensta import TIMED, opensta
from talbot.models.parameters import check_real
from talbot.signoff.netlist.netlist import Netlist

SLEWS = (
    TIMED
    + """
set sta_report_default_digits 5
foreach pin [get_pins *] {{ report_slews $pin }}
"""
)


KINDS = "internal", "switching", "leakage"


@dataclass(frozen=True)
class PowerParameters:
    """Module, corner and period of the clock."""

    top: str = ""
    corner: str = ""
    period_ns: float = field(default=20.0, metadata={"unit": "ns"})

    def __post_init__(self) -> None:
        check_real("period_ns", self.period_ns, 0.5, 1e4)


class Power(CornerStep[PowerParameters]):
    """Mean power over the trace, without the loads of the outputs.

    Slews are OpenSTA's, transitions those of the simulation with delays (glitches included), capacitances those of the
    extraction.
    """

    name = "power_{corner}"
    inputs = {"netlist": "stream_out.netlist", "verilog": "stream_out.verilog", "spef": "extraction.{wires}"}
    inputs |= {"sdc": "sdc", "liberty": "timing.{corner}", "activity": "gate_delays_{corner}.activity"}
    outputs = {"instances": "power.json"}
    metrics = {"power_uw": "uW", "by_kind": "uW", "by_block": "uW", "energy_pj_cycle": "pJ", "transitions_cycle": ""}
    tools = ("openroad",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        p, netlist = self.parameters, Netlist.read(inputs["netlist"])
        cells, activity = Cells(read(inputs["liberty"])), json.loads(inputs["activity"].read_text(encoding="utf-8"))
        wires, slews = wire_pf(inputs["spef"].read_text(encoding="utf-8")), self.slews(inputs, outputs)
        found = powers(netlist, cells, activity, wires, slews, p.period_ns)
        where = blocks(netlist)
        by_block: dict[str, float] = {}
        for name, power in found.items():
            by_block[where[name]] = by_block.get(where[name], 0.0) + power.total
        total = sum(power.total for power in found.values())
        outputs["instances"].write_text(
            json.dumps({name: power.total for name, power in found.items()}, indent=0), encoding="utf-8"
        )
        by_kind = {kind: sum(getattr(power, kind) for power in found.values()) for kind in KINDS}
        return {
            "power_uw": round(total, 4),
            "by_kind": {kind: round(value, 4) for kind, value in by_kind.items()},
            "by_block": {name: round(value, 4) for name, value in sorted(by_block.items(), key=lambda x: -x[1])},
            "energy_pj_cycle": round(total * p.period_ns / 1000, 4),
            "transitions_cycle": round(sum(toggles for toggles, _ in activity.values()), 2),
        }

    def slews(self, inputs: Files, outputs: Files) -> dict[tuple[str, str], float]:
        """Slew (ns) of each (instance, pin), the slower edge."""
        report = opensta(outputs["instances"].with_suffix(".log"), SLEWS.format(top=self.parameters.top, **inputs))
        found = re.findall(r"(?m)^(\S+)/([^/\s]+) \^ \S+?:(\S+) v \S+?:(\S+)$", report)
        return {(name.replace("\\", ""), pin): max(float(rise), float(fall)) for name, pin, rise, fall in found}


def wire_pf(spef: str) -> dict[str, float]:
    """Capacitance (pF) of each net in a SPEF in fF or pF, of the extraction step or of another tool's."""
    unit = re.search(r"(?m)^\*C_UNIT (\S+) (\w+)", spef)
    scale = float(unit[1]) * (1.0 if unit[2].upper() == "PF" else 1e-3) if unit else 1e-3
    names = dict(re.findall(r"(?m)^(\*\d+) (\S+)$", spef))
    found = re.findall(r"(?m)^\*D_NET (\S+) (\S+)$", spef)
    return {names.get(name, name).replace("\\", ""): float(value) * scale for name, value in found}
