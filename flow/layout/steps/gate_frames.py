"""Whole frames through the chip's netlist in Icarus, with X: every byte must be that of the golden model."""

import tempfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from talbot.base.steps import Files, Step
from talbot.imaging.simulate.build import Build
from talbot.imaging.simulate.icarus import icarus_program
from talbot.rtl.sensor_options import sensor_with

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from talbot.models.parameters import SensorParameters, Window

SEED, TAPS, TRIM = 1, 4, 7
FIRST = 3, 5  # row and column of the window's first tile
TILES = 2, 4  # rows and columns of tiles


@dataclass(frozen=True)
class GateFramesParameters:
    """The sensor that is simulated.

    options: of the sensor, as of rtl.export; () for the standard sensor.
    """

    options: tuple[str, ...] = ()


class GateFrames(Step[GateFramesParameters]):
    """A window of at most 2 x 4 tiles of the sensor in every mode, configured and read back over SPI. Zero delay."""

    name = "gate_frames"
    inputs = {"verilog": "stream_out.verilog", "cells": "library.verilog"}
    outputs = {"log": "frames.txt"}
    metrics = {"passed": "", "failed": "", "cycles": "", "bytes": ""}
    tools = ("iverilog",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        from talbot.imaging.frame.hardware import simulate
        from talbot.models.chip import front_end_of, golden_frame
        from talbot.models.parameters import MODES, FrameParameters

        sensor = sensor_with(self.parameters.options)
        front_end, samples = front_end_of(sensor, [TRIM] * sensor.tile.n_types), exposure(sensor)
        lines, cycles, sent = [], 0, 0
        with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
            program = icarus_program(Build.of(sensor), Path(folder), [inputs["verilog"], inputs["cells"]])
            for mode in MODES:
                phase = mode == "tof" and sensor.chip.has_phase_path
                frame = FrameParameters(few(sensor.full_window), mode, phase=phase)
                chip = simulate(program, sensor, frame, samples, front_end)
                golden = golden_frame(samples, sensor, frame, front_end)
                made, wrong = chip.status["conversions_made"], chip.status["cfg_err"]
                same = "equal" if chip.stream == golden.stream and made == golden.made and not wrong else "DIFFERENT"
                cycles, sent = cycles + chip.cycles, sent + len(chip.stream)
                lines.append(f"{mode}: {len(chip.stream)} bytes in {chip.cycles} cycles: {same}")
        outputs["log"].write_text("\n".join(lines) + "\n", encoding="utf-8")
        failed = sum(line.endswith("DIFFERENT") for line in lines)
        return {"passed": len(lines) - failed, "failed": failed, "cycles": cycles, "bytes": sent}


def few(full: "Window") -> "Window":
    """TILES from FIRST on, of these those that there are in the window ``full``."""
    row, col = min(FIRST[0], full.row1), min(FIRST[1], full.col1)
    return replace(
        full, row0=row, row1=min(row + TILES[0] - 1, full.row1), col0=col, col1=min(col + TILES[1] - 1, full.col1)
    )


def exposure(sensor: "SensorParameters") -> "npt.NDArray[np.float64]":
    """Random diode pairs (4, rows, cols, 2), some with differences beyond the converters' range."""
    import numpy as np

    rng = np.random.default_rng(SEED)
    common = rng.uniform(0, 128, (TAPS, sensor.array.rows, sensor.array.cols, 1))
    return common + rng.normal(0, 20.0, (*common.shape[:3], 2)) * (rng.random(common.shape) < 0.3)
