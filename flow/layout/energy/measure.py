"""One frame through the chip's netlist, every net's transitions counted, and their energy."""

import json
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from talbot.base.liberty.read import read
from talbot.base.steps import Files, Step, StepError
from talbot.flow.frame.hardware import simulate
from talbot.flow.frame.request import FrameRequest
from talbot.flow.frame.result import Exposed
from talbot.flow.simulate.build import Build
from talbot.flow.simulate.frame import FrameRun, host_script, run_frame
from talbot.flow.simulate.icarus import icarus_program
from talbot.models.afe import write_converter, write_samples
from talbot.models.chip import golden_frame
from talbot.models.digital.host import command, frame_writes, write_transfers
from talbot.models.parameters.registers import array_resets, register_map

from ..netlist.netlist import Netlist
from ..power.energy import Cells, Power, blocks, powers
from ..steps.corner import CornerStep
from ..steps.power import Power as PowerStep
from ..steps.power import PowerParameters, wire_pf
from .count import PARTS, counted_verilog, read_counts
from .frames import EnergyFrame, frame_named

UNIT_NS = 1000.0  # a "cycle" of `powers` in which uW are pJ


@dataclass(frozen=True)
class FrameParameters:
    """The frame, of `frames`."""

    frame: EnergyFrame = EnergyFrame("edge")

    def __post_init__(self) -> None:
        if frame_named(self.frame.name) != self.frame:
            raise StepError(f"frame {self.frame.name}: must be the one of that name")


@dataclass(frozen=True)
class MeasureParameters(FrameParameters):
    """The frame, and the corner."""

    corner: str = ""


class Transitions(Step[FrameParameters]):
    """How often each net changes in a frame at zero delay; the stream must be the golden model's.

    counts: cycles and transitions by part of the run (`count.PARTS`). events: `DigitalEvents`.
    """

    name = "transitions"
    inputs = {"netlist": "repair.netlist", "cells": "library.verilog"}
    outputs = {"counts": "counts.json"}
    metrics = {"cycles": "", "transitions": "", "bytes": "", "events": ""}
    tools = ("iverilog",)

    def __init__(self, parameters: FrameParameters) -> None:
        super().__init__(parameters)
        self.name = f"{self.name}_{parameters.frame.name}"

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        netlist = Netlist.read(inputs["netlist"])
        asked, exposed = self.parameters.frame.shot()
        with tempfile.TemporaryDirectory(prefix="talbot-") as name:
            folder = Path(name)
            (folder / "chip.v").write_text(counted_verilog(netlist))
            build = Build.of(asked.sensor, exposed.samples.shape[0])
            program = icarus_program(build, folder, [folder / "chip.v", inputs["cells"]], ("Meter",))
            seen = _play(program, asked, exposed, folder, self.parameters.frame.recorded)
            parts = read_counts(folder / "counts", netlist)
        golden = golden_frame(exposed.samples, asked.sensor, asked.frame, exposed.front_end)
        if seen.stream != golden.stream:
            raise StepError(f"{self.name}: the netlist's frame is not the golden chip's")
        outputs["counts"].write_text(json.dumps({name: vars(part) for name, part in parts.items()}, indent=0) + "\n")
        return {
            "cycles": {name: part.cycles for name, part in parts.items()},
            "transitions": {name: sum(part.transitions.values()) for name, part in parts.items()},
            "bytes": len(seen.stream),
            "events": golden.digital_events(seen.activity["busy"])._asdict(),
        }


def _play(program: Path, asked: FrameRequest, exposed: Exposed, folder: Path, whole: bool) -> FrameRun:
    """Run a frame. whole: every register is written and the status read, else only what differs from the resets."""
    sensor, front_end, more = asked.sensor, exposed.front_end, (f"+counts={folder / 'counts'}",)
    if whole:
        return simulate(program, sensor, asked.frame, exposed.samples, front_end, more=more)
    array, tile, chip = sensor.array, sensor.tile, register_map()
    sizes = array.rows, array.cols, sensor.chip.lanes, tile.rows, tile.cols, sensor.chip.divider
    resets = chip.image(chip.configuration, array_resets(*sizes))
    writes = [(at, byte) for at, byte in frame_writes(asked.frame, front_end.trim) if resets[at] != byte]
    write_samples(folder / "samples", exposed.samples)
    write_converter(folder / "converter", front_end)
    script = host_script([*write_transfers(writes), command("start")], [])
    return run_frame(program, folder / "samples", folder / "converter", script, more=more)


class Slews(CornerStep[PowerParameters]):
    """Slew of every pin by OpenSTA, as of the step `power`."""

    name = "slews_{corner}"
    inputs = {"verilog": "stream_out.verilog", "spef": "extraction.{wires}", "sdc": "sdc", "liberty": "timing.{corner}"}
    outputs = {"slews": "slews.json"}
    metrics = {"pins": ""}
    tools = ("sta",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        found = PowerStep(self.parameters).slews(inputs, {"instances": outputs["slews"]})
        outputs["slews"].write_text(json.dumps([[*pin, ns] for pin, ns in found.items()]) + "\n")
        return {"pins": len(found)}


class Measure(CornerStep[MeasureParameters]):
    """Energy of a frame's transitions: that inside the cells and of their loads, without those of the outputs.

    pj: of each part of the run; leakage apart. by_block: of the part frame.
    """

    name = "energy_{corner}"
    inputs = {"netlist": "repair.netlist", "liberty": "timing.{corner}", "spef": "extraction.{wires}"}
    inputs |= {"slews": "slews_{corner}.slews"}
    outputs = {"instances": "energy.json"}
    metrics = {"pj": "pJ", "by_block": "pJ", "leakage_uw": "uW", "supply_v": "V"}

    def __init__(self, parameters: MeasureParameters) -> None:
        super().__init__(parameters)
        self.name = f"{self.name}_{parameters.frame.name}"
        self.inputs = {**self.inputs, "counts": f"transitions_{parameters.frame.name}.counts"}

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        netlist, cells = Netlist.read(inputs["netlist"]), Cells(read(inputs["liberty"]))
        wires, where = wire_pf(inputs["spef"].read_text()), blocks(netlist)
        slews = {(name, pin): ns for name, pin, ns in json.loads(inputs["slews"].read_text())}
        parts, found = json.loads(inputs["counts"].read_text()), {}
        for name in PARTS:
            activity = {net: (float(count), 0.0) for net, count in parts[name]["transitions"].items()}
            found[name] = powers(netlist, cells, activity, wires, slews, UNIT_NS)
        by_block = dict.fromkeys(where.values(), 0.0)
        switched = {name: _switched(power) for name, power in found["frame"].items()}
        for name, pj in switched.items():
            by_block[where[name]] += pj
        outputs["instances"].write_text(json.dumps(switched, indent=0) + "\n")
        return {
            "pj": {name: round(sum(map(_switched, own.values())), 3) for name, own in found.items()},
            "by_block": {name: round(pj, 3) for name, pj in sorted(by_block.items(), key=lambda item: -item[1])},
            "leakage_uw": round(sum(power.leakage for power in found["frame"].values()), 6),
            "supply_v": cells.supply_v,
        }


def _switched(power: Power) -> float:
    return power.internal + power.switching
