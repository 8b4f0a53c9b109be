"""Files of the analog blocks: their black boxes, and a user's circuits in the place of those that we draw."""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from talbot.base.paths import ROOT
from talbot.base.tools import run
from talbot.flow.layout.sensor.plan import BLOCKS
from talbot.flow.layout.sensor.steps.drawing import sensor_options
from talbot.models.parameters import STANDARD, ParameterError, SensorParameters
from talbot.signoff.black_box import extra_pins

KINDS = "lef", "gds"


class AnalogFiles(NamedTuple):
    """Files by name: '<block>.black_box', its LEF; a user's '<block>.lef' and '<block>.gds'.

    drawn: all other blocks.
    """

    paths: dict[str, Path]
    drawn: tuple[str, ...]


def files(folder: Path, pdk: str, analog: Path | None = None, sensor: SensorParameters = STANDARD) -> AnalogFiles:
    """Write the black boxes into ``folder``; find a user's blocks in ``analog``.

    Raises ParameterError for blocks that do not fit, before anything is drawn.
    """
    circuits = dict.fromkeys(_circuits(analog), analog) if analog else {}
    with TemporaryDirectory() as given:
        options = "--pdk", pdk, *sensor_options(sensor, Path(given)), "--out", str(folder)
        run([sys.executable, "-m", "talbot.pixels.footprints", *options], cwd=ROOT)
    found = {f"{block}.black_box": folder / f"{block}.lef" for block in BLOCKS}
    for block, place in circuits.items():
        found |= {f"{block}.{kind}": place / f"{block}.{kind}" for kind in KINDS}
        extra_pins(found[f"{block}.lef"], found[f"{block}.black_box"])
    return AnalogFiles(found, tuple(block for block in BLOCKS if block not in circuits))


def _circuits(folder: Path) -> list[str]:
    """Names of the blocks in the user's folder."""
    if not folder.is_dir():
        raise ParameterError(f"analog = {folder}: no such folder")
    present = [block for block in BLOCKS if any((folder / f"{block}.{kind}").is_file() for kind in KINDS)]
    lacking = [f"{block}.{kind}" for block in present for kind in KINDS if not (folder / f"{block}.{kind}").is_file()]
    if lacking or not present:
        wanted = ", ".join(lacking) or f"<block>.lef and <block>.gds of {', '.join(BLOCKS)}, or of some of them"
        raise ParameterError(f"analog = {folder}: must have {wanted}")
    return present
