"""The analog blocks that this project draws."""

import shutil
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, ClassVar

from talbot.base.paths import ROOT
from talbot.base.steps import Files, Step
from talbot.base.tools import run
from talbot.flow.layout.sensor.plan import BLOCKS
from talbot.models.parameters import STANDARD, SensorParameters
from talbot.models.parameters.sensor_file import sensor_text

ARRAY = "pixel_array"


def files_of(blocks: Iterable[str]) -> dict[str, str]:
    """LEF and GDS of blocks."""
    return {file: file for block in blocks for file in (f"{block}.lef", f"{block}.gds")}


@dataclass(frozen=True)
class DrawingParameters:
    """Process and sensor."""

    pdk: str = "sky130"
    sensor: SensorParameters = STANDARD


class Drawing(Step[DrawingParameters]):
    """LEF and GDS of a sensor's blocks, as ``module`` draws them."""

    shared = True
    module: ClassVar[str]
    tools = ("klayout", "python klayout")

    def starts(self) -> Iterable[str]:
        """The module."""
        return (self.module,)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        p = self.parameters
        with TemporaryDirectory() as folder:
            options = sensor_options(p.sensor, Path(folder))
            run([sys.executable, "-m", self.module, "--pdk", p.pdk, *options, "--out", folder], cwd=ROOT)
            for name, path in outputs.items():
                shutil.copyfile(Path(folder) / name, path)
        return {}


def sensor_options(sensor: SensorParameters, folder: Path) -> tuple[str, ...]:
    """Options of a module that draws blocks of ``sensor``, whose file is written into ``folder``."""
    path = folder / "sensor.toml"
    path.write_text(sensor_text(sensor), encoding="utf-8")
    return "--sensor", str(path)


class DrawnPixels(Drawing):
    """The array of pixels."""

    name = "drawn_pixels"
    module = "talbot.pixels.layout.write"
    outputs = files_of([ARRAY])


class DrawnCircuits(Drawing):
    """All other blocks, each compared with its circuit."""

    name = "drawn_circuits"
    module = "talbot.pixels.post_layout.write"
    outputs = files_of(block for block in BLOCKS if block != ARRAY)
