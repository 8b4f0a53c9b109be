"""One frame through the chip's netlist, every net's transitions counted, and their energy."""

import json
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from talbot.base.liberty.read import read
from talbot.base.steps import Files, StepError
from talbot.flow.frame.hardware import simulate
from talbot.flow.simulate.build import Build
from talbot.flow.simulate.icarus import icarus_program
from talbot.models.chip import golden_frame

from ..netlist.netlist import Netlist
from ..power.energy import Cells, blocks, powers
from ..power.energy import Power as InstancePower
from ..steps.corner import CornerStep
from ..steps.power import Power, PowerParameters, wire_pf
from .count import PARTS, counted_verilog, read_counts
from .events import digital_events
from .frames import EnergyFrame, frame_named

UNIT_NS = 1000.0  # a "cycle" of `powers` in which uW are pJ


@dataclass(frozen=True)
class MeasureParameters:
    """Module, corner, frame (`frames`)."""

    top: str = "AspChip"
    corner: str = ""
    frame: EnergyFrame = EnergyFrame("edge")

    def __post_init__(self) -> None:
        if frame_named(self.frame.name) != self.frame:
            raise StepError(f"frame {self.frame.name}: must be the one of that name")


class Measure(CornerStep[MeasureParameters]):
    """Energy of a frame at the gates, zero delay: cells' internal energy and that of their loads, without the outputs'.

    The stream must be the golden model's. pj: of the parts of the run, host (configuration over SPI), frame (chip busy)
    and after (status); leakage apart. by_block: of the part frame. transitions: a net's settled values.
    """

    name = "energy_{corner}"
    inputs = {"netlist": "repair.netlist", "cells": "library.verilog", "liberty": "timing.{corner}"}
    inputs |= {"verilog": "stream_out.verilog", "spef": "extraction.{wires}", "sdc": "sdc"}
    outputs = {"instances": "energy.json"}
    metrics = {"pj": "pJ", "cycles": "", "by_block": "pJ", "leakage_uw": "uW", "transitions": "", "events": ""}
    metrics |= {"supply_v": "V"}
    tools = ("iverilog", "sta")

    def __init__(self, parameters: MeasureParameters) -> None:
        super().__init__(parameters)
        self.name += f"_{parameters.frame.name}"

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        p, netlist = self.parameters, Netlist.read(inputs["netlist"])
        asked, exposed = p.frame.shot()
        sensor, frame = asked.sensor, asked.frame
        with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
            chip, counts = Path(folder) / "chip.v", Path(folder) / "counts"
            chip.write_text(counted_verilog(netlist))
            taps = exposed.samples.shape[0]
            program = icarus_program(Build.of(sensor, taps), Path(folder), [chip, inputs["cells"]], ("Meter",))
            more = (f"+counts={counts}",)
            seen = simulate(program, sensor, frame, exposed.samples, exposed.front_end, more=more)
            parts = read_counts(counts, netlist)
        golden = golden_frame(exposed.samples, sensor, frame, exposed.front_end)
        if seen.stream != golden.stream:
            raise StepError(f"{self.name}: the netlist's frame is not the golden chip's")
        cells, wires = Cells(read(inputs["liberty"])), wire_pf(inputs["spef"].read_text())
        slews = Power(PowerParameters(p.top, p.corner)).slews(inputs, outputs)
        found = {
            name: powers(netlist, cells, {net: (float(n), 0.0) for net, n in part.transitions.items()}, wires, slews,
                         UNIT_NS)
            for name, part in parts.items()
        }  # fmt: skip
        own, where = found["frame"], blocks(netlist)
        by_block = dict.fromkeys(where.values(), 0.0)
        for name, power in own.items():
            by_block[where[name]] += switched(power)
        outputs["instances"].write_text(json.dumps({name: switched(power) for name, power in own.items()}, indent=0))
        return {
            "pj": {name: round(total(found[name]), 3) for name in PARTS},
            "cycles": {name: parts[name].cycles for name in PARTS},
            "by_block": {name: round(pj, 3) for name, pj in sorted(by_block.items(), key=lambda item: -item[1])},
            "leakage_uw": round(sum(power.leakage for power in own.values()), 6),
            "transitions": sum(parts["frame"].transitions.values()),
            "events": digital_events(golden, seen.activity["busy"])._asdict(),
            "supply_v": cells.supply_v,
        }


def switched(power: InstancePower) -> float:
    """What an instance takes by its transitions."""
    return power.internal + power.switching


def total(found: Mapping[str, InstancePower]) -> float:
    """What all instances take by their transitions."""
    return sum(map(switched, found.values()))
