"""The die's wires as the chip's timing sees them: loads and delays at its ports."""

import json
from dataclasses import dataclass, field

from base.steps import Step
from flow.layout.timing import parasitics
from platforms.coriolis import coriolis_platform

from . import elmore
from .plan import CORE


@dataclass(frozen=True)
class DieWiresParameters:
    """pdk: process. clock: port. pin_pf: of every pin at the far end of a wire, an assumption. load_pf: for which the
    chip's outputs were laid out. input_ns, output_ns: delays that the chip's constraints leave to what is around it;
    those of the die's wires are added."""

    pdk: str = "sky130"
    clock: str = "clk"
    pin_pf: float = field(default=0.02, metadata={"unit": "pF"})
    load_pf: float = field(default=0.25, metadata={"unit": "pF"})
    input_ns: float = field(default=4.0, metadata={"unit": "ns"})
    output_ns: float = field(default=4.0, metadata={"unit": "ns"})


class DieWires(Step):
    """Capacitance to the substrate and resistance of every routed net, Elmore's delay to its slowest pin, and the
    chip's constraints with these loads and delays.

    worst_load_pf: of an output of the chip, wires and pins. worst_delay_ns: of a wire, the driver left out.
    loads_over: outputs of the chip with more than the load that it was laid out for.
    """

    name = "die_wires"
    inputs = {"plan": "die_plan.plan", "sdc": "core.sdc"}
    outputs = {"nets": "wires.json", "sdc": "die.sdc"}
    Parameters = DieWiresParameters
    metrics = {
        "wire_pf": "pF",
        "worst_load_pf": "pF",
        "worst_load": "",
        "worst_delay_ns": "ns",
        "worst_delay": "",
        "loads_over": "",
    }
    uses = (elmore, parasitics)

    def run(self, inputs, outputs):
        p, plan = self.parameters, json.loads(inputs["plan"].read_text())
        known = coriolis_platform(p.pdk)
        nets = {}
        for net, route in plan["routes"].items():
            driver = tuple(plan["drivers"][net])
            femto, found = elmore.net(route["reaches"], route["y"], driver, plan["tracks"], known, p.pin_pf)
            nets[net] = {
                "driver": driver[0],
                "wire_ff": round(femto, 3),
                "load_pf": round(femto / 1000 + len(found) * p.pin_pf, 6),
                "delay_ns": {f"{block}.{pin}": round(ns, 6) for (block, pin), ns in found.items()},
            }
        outputs["nets"].write_text(json.dumps(nets, indent=1) + "\n")
        outputs["sdc"].write_text(inputs["sdc"].read_text() + "\n".join(self.constraints(nets)) + "\n")
        driven = {net: found["load_pf"] for net, found in nets.items() if found["driver"] == CORE}
        slow = {net: max(found["delay_ns"].values()) for net, found in nets.items()}
        load, delay = max(driven, key=driven.get), max(slow, key=slow.get)
        return {
            "wire_pf": round(sum(found["wire_ff"] for found in nets.values()) / 1000, 3),
            "worst_load_pf": round(driven[load], 4),
            "worst_load": load,
            "worst_delay_ns": round(slow[delay], 4),
            "worst_delay": delay,
            "loads_over": sum(pf > p.load_pf for pf in driven.values()),
        }

    def constraints(self, nets):
        """Lines of SDC: what the chip's own say of its ports, with the die's wires."""
        p = self.parameters
        for net, found in nets.items():
            port = f"[get_ports {{{net}}}]"
            if found["driver"] == CORE:
                yield f"set_load {found['load_pf']:.6f} {port}"
                yield f"set_output_delay {p.output_ns + max(found['delay_ns'].values()):.6f} -clock {p.clock} {port}"
            elif net != p.clock:
                yield (
                    f"set_input_delay {p.input_ns + found['delay_ns'][f'{CORE}.{net}']:.6f} -max -clock {p.clock} "
                    f"{port}"
                )
