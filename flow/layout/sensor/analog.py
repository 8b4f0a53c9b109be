"""The analog blocks' files: frames written by `pixels.footprints`, or those of a user's circuits in their place."""

import sys
from pathlib import Path

from base.lef.read import read_macro
from base.paths import ROOT
from base.tools import run
from models.parameters import ParameterError

from .plan import BLOCKS

KINDS = "lef", "gds"


def files(folder, pdk, analog=None):
    """(dict '<block>.lef' and '<block>.gds' -> Path, names of the blocks that are frames, extra pins: tuple).

    folder: where the frames are written. analog: of the user's blocks, each with LEF and GDS; what is not there stays
    a frame. A pin that a frame does not have, a reference or a bias, leads to one of the die. Raises ParameterError.
    """
    theirs, extra = _theirs(Path(analog)) if analog else [], {}
    run([sys.executable, "-m", "pixels.footprints", "--pdk", pdk, "--out", folder], cwd=ROOT)
    found = {f"{block}.{kind}": Path(folder) / f"{block}.{kind}" for block in BLOCKS for kind in KINDS}
    for block in theirs:
        extra |= dict.fromkeys(check(Path(analog) / f"{block}.lef", found[f"{block}.lef"]))
        found |= {f"{block}.{kind}": Path(analog) / f"{block}.{kind}" for kind in KINDS}
    return found, [block for block in BLOCKS if block not in theirs], tuple(extra)


def _theirs(folder):
    """Names of the blocks that the user's folder has."""
    if not folder.is_dir():
        raise ParameterError(f"analog = {folder}: no such folder")
    there = [block for block in BLOCKS if any((folder / f"{block}.{kind}").is_file() for kind in KINDS)]
    lacking = [f"{block}.{kind}" for block in there for kind in KINDS if not (folder / f"{block}.{kind}").is_file()]
    if lacking or not there:
        raise ParameterError(
            f"analog = {folder}: must have "
            + (", ".join(lacking) or f"<block>.lef and <block>.gds of {', '.join(BLOCKS)}, or of some of them")
        )
    return there


def check(path, frame):
    """Names of the pins that the LEF ``path`` has more than ``frame``. Raises ParameterError unless it has those of
    ``frame`` with their directions."""
    (own, asked) = (
        {pin.name: pin.direction.upper() for pin in read_macro(file.read_text(errors="replace")).pins.values()}
        for file in (path, frame)
    )
    if lacking := [pin for pin in asked if pin not in own]:
        raise ParameterError(
            f"analog = {path}: must have the pins {', '.join(lacking[:5])}"
            + (f" and {len(lacking) - 5} more" if len(lacking) > 5 else "")
        )
    if other := [pin for pin in asked if own[pin] != asked[pin]]:
        raise ParameterError(f"analog = {path}: its pin {other[0]} must be of DIRECTION {asked[other[0]]}")
    return [pin for pin in own if pin not in asked]
