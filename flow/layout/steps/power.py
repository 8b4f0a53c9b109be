"""Power at one corner from the transitions of the netlist in its recorded trace, split by block and by kind."""

import json
import re
from dataclasses import dataclass, field

from base.liberty.read import read
from base.steps import Step
from models.parameters import check_real

from ..netlist import netlist as netlist_module
from ..netlist.netlist import Netlist
from ..power import energy as energy_module
from ..power.energy import Cells, blocks, powers
from ..timing import opensta as opensta_module
from ..timing.opensta import opensta

SLEWS = """
read_liberty {liberty}
read_verilog {verilog}
link_design {top}
source {sdc}
read_spef {spef}
set sta_report_default_digits 5
foreach pin [get_pins *] {{ report_slews $pin }}
"""


@dataclass(frozen=True)
class PowerParameters:
    """top: module. corner: its name. period_ns: of the clock."""

    top: str = ""
    corner: str = ""
    period_ns: float = field(default=20.0, metadata={"unit": "ns"})

    def __post_init__(self):
        check_real("period_ns", self.period_ns, 0.5, 1e4)


class Power(Step):
    """power_uw: what the block draws from its supply, on average over the trace, the loads of its outputs left out.

    Slews are OpenSTA's, transitions the delayed simulation's (glitches too), capacitances the extraction's.
    """

    inputs = {
        "netlist": "place_route.netlist",
        "verilog": "stream_out.verilog",
        "spef": "extraction.spef",
        "sdc": "sdc",
    }
    outputs = {"instances": "power.json"}
    Parameters = PowerParameters
    metrics = {"power_uw": "uW", "by_kind": "uW", "by_block": "uW", "energy_pj_cycle": "pJ", "transitions_cycle": ""}
    uses = (energy_module, netlist_module, opensta_module)
    tools = ("sta",)

    def __init__(self, parameters):
        super().__init__(parameters)
        corner = parameters.corner
        self.name = f"power_{corner}"
        self.inputs = self.inputs | {"liberty": f"timing.{corner}", "activity": f"gate_delays_{corner}.activity"}

    def run(self, inputs, outputs):
        p, netlist = self.parameters, Netlist.read(inputs["netlist"])
        cells, activity = Cells(read(inputs["liberty"])), json.loads(inputs["activity"].read_text())
        found = powers(
            netlist, cells, activity, wire_pf(inputs["spef"].read_text()), self.slews(inputs, outputs), p.period_ns
        )
        where = blocks(netlist)
        by_block = {}
        for name, power in found.items():
            by_block[where[name]] = by_block.get(where[name], 0.0) + power.total
        total = sum(power.total for power in found.values())
        outputs["instances"].write_text(json.dumps({name: power.total for name, power in found.items()}, indent=0))
        return {
            "power_uw": round(total, 4),
            "by_kind": {
                kind: round(sum(getattr(power, kind) for power in found.values()), 4)
                for kind in ("internal", "switching", "leakage")
            },
            "by_block": {name: round(value, 4) for name, value in sorted(by_block.items(), key=lambda x: -x[1])},
            "energy_pj_cycle": round(total * p.period_ns / 1000, 4),
            "transitions_cycle": round(sum(toggles for toggles, _ in activity.values()), 2),
        }

    def slews(self, inputs, outputs):
        """dict (instance, pin) -> ns, the slower edge."""
        said = opensta(outputs["instances"].with_suffix(".log"), SLEWS.format(top=self.parameters.top, **inputs))
        return {
            tuple(name.replace("\\", "").rsplit("/", 1)): max(float(rise), float(fall))
            for name, rise, fall in re.findall(r"(?m)^(\S+/\S+) \^ \S+?:(\S+) v \S+?:(\S+)$", said)
        }


def wire_pf(spef):
    """dict net -> pF of a SPEF as the extraction writes it (fF)."""
    return {
        name.replace("\\", ""): float(value) / 1000 for name, value in re.findall(r"(?m)^\*D_NET (\S+) (\S+)$", spef)
    }
