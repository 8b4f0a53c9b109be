"""The analog blocks that this project draws."""

import shutil
import sys
from collections.abc import Iterable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, ClassVar

from talbot.base.paths import ROOT
from talbot.base.steps import Files, Step
from talbot.base.tools import run
from talbot.flow.layout.sensor.plan import BLOCKS
from talbot.flow.layout.steps.parameters import PdkParameters

ARRAY = "pixel_array"


def files_of(blocks: Iterable[str]) -> dict[str, str]:
    """LEF and GDS of blocks."""
    return {file: file for block in blocks for file in (f"{block}.lef", f"{block}.gds")}


class Drawing(Step[PdkParameters]):
    """LEF and GDS of blocks, as ``module`` draws them."""

    shared = True
    module: ClassVar[str]
    tools = ("klayout", "python klayout")

    def starts(self) -> Iterable[str]:
        """The module."""
        return (self.module,)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        with TemporaryDirectory() as folder:
            run([sys.executable, "-m", self.module, "--pdk", self.parameters.pdk, "--out", folder], cwd=ROOT)
            for name, path in outputs.items():
                shutil.copyfile(Path(folder) / name, path)
        return {}


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
