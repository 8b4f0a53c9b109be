"""IR drop by OpenROAD's solver, from the transitions of the recorded frame."""

import csv
import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from talbot.base import openroad
from talbot.base.steps import Files, StepError
from talbot.base.tools import finish
from talbot.flow.layout.steps.corner import CornerStep
from talbot.signoff.netlist.netlist import OUTPUT_PINS, Netlist

SCRIPT = """
read_liberty {liberty}
read_db {database}
read_sdc {sdc}
read_spef {spef}
source {activity}
set_pdnsim_net_voltage -net {supply} -voltage {volts}
set_pdnsim_net_voltage -net {ground} -voltage 0
analyze_power_grid -net {supply} -voltage_file {supply_csv}
analyze_power_grid -net {ground} -voltage_file {ground_csv}
"""


@dataclass(frozen=True)
class IrDropParameters:
    """Corner of the power, its supply voltage, names of the supply nets."""

    corner: str = ""
    volts: float = 1.8
    supply: str = "VPWR"
    ground: str = "VGND"


class IrDrop(CornerStep[IrDropParameters]):
    """Rails, straps, vias as resistors, the straps' pins at the supply; static: the mean over the trace, no peaks."""

    name = "ir_drop_{corner}"
    inputs = {"database": "database", "sdc": "sdc", "spef": "extraction.typ", "netlist": "stream_out.netlist"}
    inputs |= {"liberty": "timing.{corner}", "activity": "gate_delays_{corner}.activity"}
    outputs = {"supply": "supply.csv", "ground": "ground.csv"}
    metrics = {"supply_drop_mv": "mV", "ground_rise_mv": "mV", "ir_drop_percent": "%"}
    tools = ("openroad",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        p, folder = self.parameters, outputs["supply"].parent
        script, activity = folder / "script.log", folder / "activity.log"
        activity.write_text(
            activities(Netlist.read(inputs["netlist"]), json.loads(inputs["activity"].read_text(encoding="utf-8"))),
            encoding="utf-8",
        )
        files = {name: inputs[name].resolve() for name in ("liberty", "database", "sdc", "spef")}
        files |= {"activity": activity, "supply_csv": outputs["supply"], "ground_csv": outputs["ground"]}
        script.write_text(SCRIPT.format(volts=p.volts, supply=p.supply, ground=p.ground, **files), encoding="utf-8")
        done = finish(openroad.command(script))
        (folder / "openroad.log").write_text(done.stdout + done.stderr, encoding="utf-8")
        if done.returncode or not all(path.is_file() for path in outputs.values()):
            raise StepError(f"{self.name}: openroad: {(done.stdout + done.stderr).strip().splitlines()[-3:]}")
        drop = (p.volts - min(voltages(outputs["supply"]))) * 1000
        rise = max(voltages(outputs["ground"])) * 1000
        percent = (drop + rise) / p.volts / 10
        found = {"supply_drop_mv": drop, "ground_rise_mv": rise, "ir_drop_percent": percent}
        return {name: float(f"{value:.4g}") for name, value in found.items()}


def activities(netlist: Netlist, activity: Mapping[str, tuple[float, float]]) -> str:
    """Commands that give the pin that drives each net its (transitions a cycle, share of time at 1)."""
    drivers = {net: (i.name, pin) for i in netlist.instances for pin, net in i.pins.items() if pin in OUTPUT_PINS}
    lines = []
    for net, (toggles, high) in activity.items():
        values = f"-activity {toggles:.6f} -duty {min(1.0, max(0.0, high)):.6f}"
        if net in drivers:
            instance, pin = drivers[net]
            lines.append(f"set_power_activity -pins [get_pins {{{_escaped(instance)}/{pin}}}] {values}")
        else:
            lines.append(f"set_power_activity -input_ports [get_ports {{{_escaped(net)}}}] {values}")
    return "\n".join([*lines, ""])


def _escaped(name: str) -> str:
    """For a pattern of OpenSTA, in which brackets are special."""
    return re.sub(r"([\[\]])", r"\\\1", name)


def voltages(path: Path) -> list[float]:
    """Return the voltages of a file that OpenROAD wrote."""
    with path.open(encoding="utf-8") as file:
        return [float(row["Voltage"]) for row in csv.DictReader(file, skipinitialspace=True)]
