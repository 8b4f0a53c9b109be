"""One frame through the chip's netlist, every net's transitions counted, and their energy."""

import json
import shutil
import tempfile
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import Any

import numpy as np

from talbot.base.liberty.read import read
from talbot.base.steps import Files, Step, StepError
from talbot.base.steps.step import NoParameters
from talbot.flow.layout.energy.count import PARTS, counted_verilog, nets_of, read_counts
from talbot.flow.layout.energy.frames import EVERY, EnergyFrame, Values, frame_named
from talbot.flow.layout.power.energy import Cells, Energy, blocks, powers
from talbot.flow.layout.steps.corner import CornerStep
from talbot.flow.layout.steps.power import Power as PowerStep
from talbot.flow.layout.steps.power import PowerParameters, wire_pf
from talbot.imaging.frame.hardware import simulate
from talbot.imaging.frame.request import FrameRequest
from talbot.imaging.simulate.build import Build
from talbot.imaging.simulate.frame import FrameRun, host_script, run_frame
from talbot.imaging.simulate.icarus import icarus_program
from talbot.models.afe import FrontEnd, write_converter, write_samples
from talbot.models.chip import golden_frame
from talbot.models.digital.host import command, frame_writes, write_transfers
from talbot.models.parameters import SensorParameters
from talbot.models.parameters.registers import array_resets, register_map
from talbot.signoff.netlist.netlist import Netlist

UNIT_NS = 1000.0  # a "cycle" of `powers` in which uW are pJ


@dataclass(frozen=True)
class FrameParameters:
    """The frame, of `frames`."""

    frame: EnergyFrame = EnergyFrame("edge")

    def __post_init__(self) -> None:
        if frame_named(self.frame.name) != self.frame:
            raise StepError(f"frame {self.frame.name}: must be the one of that name")


class Light(Step[FrameParameters]):
    """What the pixels hold in a frame, and the types' trims."""

    name = "light"
    outputs = {"light": "light.npz"}
    metrics = {"taps": ""}

    def __init__(self, parameters: FrameParameters) -> None:
        super().__init__(parameters)
        self.name = f"{self.name}_{parameters.frame.name}"

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        samples, trims = self.parameters.frame.light()
        np.savez_compressed(outputs["light"], samples=samples, trims=trims)
        return {"taps": samples.shape[0]}


class CountingBench(Step[NoParameters]):
    """The netlist with a counter at every net in the bench of frames, compiled by Icarus."""

    name = "counting_bench"
    inputs = {"netlist": "stream_out.netlist", "cells": "library.verilog"}
    outputs = {"program": "bench.vvp"}
    metrics = {"nets": ""}
    tools = ("iverilog",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        netlist = Netlist.read(inputs["netlist"])
        with tempfile.TemporaryDirectory(prefix="talbot-") as name:
            chip = Path(name) / "chip.v"
            chip.write_text(counted_verilog(netlist), encoding="utf-8")
            build = Build.of(SensorParameters())
            shutil.copyfile(icarus_program(build, Path(name), [chip, inputs["cells"]], ("Meter",)), outputs["program"])
        return {"nets": len(nets_of(netlist))}


class Transitions(Step[FrameParameters]):
    """How often each net changes in a frame at zero delay; the stream must be the golden model's.

    counts: cycles and transitions by part of the run (`count.PARTS`). events: `DigitalEvents`.
    """

    name = "transitions"
    inputs = {"netlist": "stream_out.netlist", "program": "counting_bench.program"}
    outputs = {"counts": "counts.json"}
    metrics = {"cycles": "", "transitions": "", "bytes": "", "events": ""}
    tools = ("iverilog",)

    def __init__(self, parameters: FrameParameters) -> None:
        super().__init__(parameters)
        frame = parameters.frame
        self.name = f"{self.name}_{frame.name}"
        self.inputs = {**self.inputs, "light": f"light_{frame.lit_as}.light"}

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        frame, netlist, light = self.parameters.frame, Netlist.read(inputs["netlist"]), np.load(inputs["light"])
        asked, samples, front_end = frame.shot(light["samples"], light["trims"].tolist())
        with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
            seen = _play(inputs["program"], asked, samples, front_end, Path(folder), frame.recorded)
            parts = read_counts(Path(folder) / "counts", netlist)
        golden = golden_frame(samples, asked.sensor, asked.frame, front_end)
        if seen.stream != golden.stream:
            raise StepError(f"{self.name}: the netlist's frame is not the golden chip's")
        outputs["counts"].write_text(
            json.dumps({name: vars(part) for name, part in parts.items()}, indent=0) + "\n", encoding="utf-8"
        )
        return {
            "cycles": {name: part.cycles for name, part in parts.items()},
            "transitions": {name: sum(part.transitions.values()) for name, part in parts.items()},
            "bytes": len(seen.stream),
            "events": golden.digital_events(seen.activity["busy"])._asdict(),
        }


def _play(
    program: Path, asked: FrameRequest, samples: Values, front_end: FrontEnd, folder: Path, whole: bool
) -> FrameRun:
    """Run a frame. whole: every register is written and the status read, else only what differs from the resets."""
    sensor, more = asked.sensor, (f"+counts={folder / 'counts'}",)
    if whole:
        return simulate(program, sensor, asked.frame, samples, front_end, more=more)
    array, tile, chip = sensor.array, sensor.tile, register_map()
    sizes = array.rows, array.cols, sensor.chip.lanes, tile.rows, tile.cols, sensor.chip.divider
    resets = chip.image(chip.configuration, array_resets(*sizes))
    writes = [(at, byte) for at, byte in frame_writes(asked.frame, front_end.trim) if resets[at] != byte]
    write_samples(folder / "samples", samples)
    write_converter(folder / "converter", front_end)
    script = host_script([*write_transfers(writes), command("start")], [])
    return run_frame(program, folder / "samples", folder / "converter", script, more=more)


class Slews(CornerStep[PowerParameters]):
    """Slew of every pin by OpenSTA, as of the step `power`."""

    name = "slews_{corner}"
    inputs = {"verilog": "stream_out.verilog", "spef": "extraction.{wires}", "sdc": "sdc", "liberty": "timing.{corner}"}
    outputs = {"slews": "slews.json"}
    metrics = {"pins": ""}
    tools = ("openroad",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        found = PowerStep(self.parameters).slews(inputs, {"instances": outputs["slews"]})
        outputs["slews"].write_text(json.dumps([[*pin, ns] for pin, ns in found.items()]) + "\n", encoding="utf-8")
        return {"pins": len(found)}


class Remembered(Cells):
    """Cells whose energies are looked up once for each slew and load, which are those of every frame."""

    def energies(self, cell: str, pin: str) -> list[tuple[str, Energy]]:
        """As of Cells."""
        key = cell, pin
        if key not in self._remembered:
            found = super().energies(cell, pin)
            self._remembered[key] = [(related, cache(energy)) for related, energy in found]
        return self._remembered[key]

    @cached_property
    def _remembered(self) -> dict[tuple[str, str], list[tuple[str, Energy]]]:
        return {}


class Measure(CornerStep[PowerParameters]):
    """Energy of the frames' transitions: that inside the cells and of their loads, without those of the outputs.

    frames: pJ of each frame, by part of the run and, of the part frame, by block; leakage apart.
    """

    name = "energy_{corner}"
    inputs = {"netlist": "stream_out.netlist", "liberty": "timing.{corner}", "spef": "extraction.{wires}"}
    inputs |= {"slews": "slews_{corner}.slews"} | {frame.name: f"transitions_{frame.name}.counts" for frame in EVERY}
    outputs = {"instances": "energy.json"}
    metrics = {"frames": "pJ", "leakage_uw": "uW", "supply_v": "V"}

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        netlist, cells = Netlist.read(inputs["netlist"]), Remembered(read(inputs["liberty"]))
        wires, where = wire_pf(inputs["spef"].read_text(encoding="utf-8")), blocks(netlist)
        slews = {(name, pin): ns for name, pin, ns in json.loads(inputs["slews"].read_text(encoding="utf-8"))}
        frames, instances, leakage = {}, {}, 0.0
        for frame in EVERY:
            parts, pj = json.loads(inputs[frame.name].read_text(encoding="utf-8")), {}
            by_block = dict.fromkeys(where.values(), 0.0)
            for part in PARTS:
                activity = {net: (float(count), 0.0) for net, count in parts[part]["transitions"].items()}
                found = powers(netlist, cells, activity, wires, slews, UNIT_NS)
                own = {name: power.internal + power.switching for name, power in found.items()}
                pj[part], leakage = round(sum(own.values()), 3), sum(power.leakage for power in found.values())
                if part == "frame":
                    instances[frame.name] = own
                    for name, energy in own.items():
                        by_block[where[name]] += energy
            split = {name: round(pj, 3) for name, pj in sorted(by_block.items(), key=lambda item: -item[1])}
            frames[frame.name] = {"pj": pj, "by_block": split}
        outputs["instances"].write_text(json.dumps(instances, indent=0) + "\n", encoding="utf-8")
        return {"frames": frames, "leakage_uw": round(leakage, 6), "supply_v": cells.supply_v}
