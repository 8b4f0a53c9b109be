"""Parasitics of the die's nets, as loads and delays at the chip's ports."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from talbot.base.steps import Files, Step
from talbot.flow.layout.sensor import coupling, elmore
from talbot.flow.layout.sensor.plan import CORE
from talbot.platforms.extraction import extraction_platform
from talbot.platforms.layout import layout_platform


@dataclass(frozen=True)
class DieParasiticsParameters:
    """Assumptions about what the nets connect.

    pdk: process. clock: port. pin_pf: of every pin but the driver's, an assumption. load_pf: for which the chip's
    outputs were laid out. input_ns, output_ns: I/O delays in the chip's constraints; those of the die's nets are added.
    """

    pdk: str = "sky130"
    clock: str = "clk"
    pin_pf: float = field(default=0.02, metadata={"unit": "pF"})
    load_pf: float = field(default=0.25, metadata={"unit": "pF"})
    input_ns: float = field(default=4.0, metadata={"unit": "ns"})
    output_ns: float = field(default=4.0, metadata={"unit": "ns"})


class DieParasitics(Step[DieParasiticsParameters]):
    """Capacitance of every routed net with coupling, its Elmore delays, the chip's constraints with both.

    At the corner of wires with the most capacitance; coupling counts as to the ground.

    worst_load_pf: of an output of the chip, net and pins. worst_delay_ns: of a net, without the driver's resistance.
    loads_over: outputs of the chip with more than the load that it was laid out for.
    """

    name = "die_parasitics"
    inputs = {"plan": "die_plan.plan", "sdc": "core.sdc"}
    outputs = {"nets": "parasitics.json", "sdc": "die.sdc"}
    metrics = {"wire_pf": "pF", "worst_load_pf": "pF", "worst_load": "", "worst_delay_ns": "ns"}
    metrics |= {"worst_delay": "", "loads_over": ""}
    tools = ("python klayout",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        p, plan = self.parameters, json.loads(inputs["plan"].read_text(encoding="utf-8"))
        tech = layout_platform(p.pdk)
        femtofarads = coupling.femtofarads(plan, tech, extraction_platform(p.pdk))
        nets: dict[str, dict[str, Any]] = {}
        for net, route in plan["routes"].items():
            block, pin = plan["drivers"][net]
            femto, driver = femtofarads[net], (block, pin)
            found = elmore.net(route["branches"], route["y"], driver, plan["tracks"], tech, p.pin_pf, femto)
            load_pf = round(femto / 1000 + len(found) * p.pin_pf, 6)
            delays = {".".join(end): round(ns, 6) for end, ns in found.items()}
            nets[net] = {"driver": block, "wire_ff": round(femto, 3), "load_pf": load_pf, "delay_ns": delays}
        outputs["nets"].write_text(json.dumps(nets, indent=1) + "\n", encoding="utf-8")
        outputs["sdc"].write_text(
            inputs["sdc"].read_text(encoding="utf-8") + "\n".join(self.constraints(nets)) + "\n", encoding="utf-8"
        )
        driven = {net: found["load_pf"] for net, found in nets.items() if found["driver"] == CORE}
        slow = {net: max(found["delay_ns"].values()) for net, found in nets.items()}
        load, delay = max(driven, key=driven.__getitem__), max(slow, key=slow.__getitem__)
        worst = {"worst_load_pf": round(driven[load], 4), "worst_load": load}
        worst |= {"worst_delay_ns": round(slow[delay], 4), "worst_delay": delay}
        wire_pf = round(sum(found["wire_ff"] for found in nets.values()) / 1000, 3)
        return {"wire_pf": wire_pf, **worst, "loads_over": sum(pf > p.load_pf for pf in driven.values())}

    def constraints(self, nets: Mapping[str, Mapping[str, Any]]) -> Iterator[str]:
        """Lines of SDC: loads and I/O delays of the chip's ports with the die's nets."""
        p = self.parameters
        for net, found in nets.items():
            port = f"[get_ports {{{net}}}]"
            if found["driver"] == CORE:
                yield f"set_load {found['load_pf']:.6f} {port}"
                latest = p.output_ns + max(found["delay_ns"].values())
                yield f"set_output_delay {latest:.6f} -max -clock {p.clock} {port}"
            elif net != p.clock and f"{CORE}.{net}" in found["delay_ns"]:  # a block's own pin may miss the chip
                latest = p.input_ns + found["delay_ns"][f"{CORE}.{net}"]
                yield f"set_input_delay {latest:.6f} -max -clock {p.clock} {port}"
