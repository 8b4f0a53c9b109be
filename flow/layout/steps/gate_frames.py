"""Whole frames through the chip's netlist in Icarus, which knows X: every byte must be the golden chip's."""

import tempfile
from pathlib import Path

from flow.simulate.process import run
from flow.steps import Step

ROOT = Path(__file__).parents[3]
FRAME = ROOT / "verif" / "frame"
MODES = (("edge", False), ("image", False), ("tof", True))      # mode, whether the chip's divider makes phases
SEED, TAPS = 1, 4


class GateFrames(Step):
    """A window of 2 x 4 tiles of the default sensor in three modes, configured and read back over SPI. Zero delay."""

    name = "gate_frames"
    inputs = {"verilog": "stream_out.verilog", "cells": "library.verilog", "bench": "frame_bench"}
    outputs = {"log": "frames.txt"}
    metrics = {"passed": "", "failed": "", "cycles": "", "bytes": ""}
    tools = ("iverilog",)

    def run(self, inputs, outputs):
        from flow.frame.hardware import simulate
        from models.digital.chip import front_end_of, golden_frame
        from models.parameters import FrameParameters, SensorParameters, Window
        sensor = SensorParameters()
        front_end, samples = front_end_of(sensor, [7] * 24), exposure(sensor)
        lines, cycles, sent = [], 0, 0
        with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
            program = compiled([inputs["verilog"], inputs["cells"]], sensor, Path(folder))
            for mode, phase in MODES:
                frame = FrameParameters(Window(3, 4, 5, 8), mode, phase=phase)
                chip = simulate(program, sensor, frame, samples, front_end)
                golden = golden_frame(samples, sensor, frame, front_end)
                same = (chip.stream == golden.stream and chip.status["conversions_made"] == golden.made
                        and not chip.status["cfg_err"])
                cycles, sent = cycles + chip.cycles, sent + len(chip.stream)
                lines.append(f"{mode}: {len(chip.stream)} bytes in {chip.cycles} cycles: "
                             f"{'equal' if same else 'DIFFERENT'}")
        outputs["log"].write_text("\n".join(lines) + "\n")
        failed = sum(line.endswith("DIFFERENT") for line in lines)
        return {"passed": len(lines) - failed, "failed": failed, "cycles": cycles, "bytes": sent}


def exposure(sensor):
    """Random diode pairs (4, rows, cols, 2), their differences now and then beyond the converters' range."""
    import numpy as np
    rng = np.random.default_rng(SEED)
    common = rng.uniform(0, 128, (TAPS, sensor.array.rows, sensor.array.cols, 1))
    return common + rng.normal(0, 20.0, (*common.shape[:3], 2)) * (rng.random(common.shape) < 0.3)


def compiled(chip, sensor, folder, tops=()):
    """The frame bench around the Verilog files ``chip``, compiled by Icarus into ``folder``: its path.

    tops: modules beside the bench.
    """
    program = folder / "bench.vvp"
    sizes = {"ROWS": sensor.array.rows, "COLS": sensor.array.cols, "LANES": sensor.chip.lanes,
             "TILE_ROWS": sensor.tile.rows, "TILE_COLS": sensor.tile.cols, "TAPS": TAPS}
    run(["iverilog", "-g2012", "-s", "Clock", *(part for top in tops for part in ("-s", top)),
         *(f"-PClock.{name}={value}" for name, value in sizes.items()),
         "-o", program, *chip, ROOT / "pixels" / "afe.sv", FRAME / "bench.sv", FRAME / "clock.sv"])
    return program
