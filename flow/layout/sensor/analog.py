"""Files of the analog blocks: the drawn pixel array, black boxes of the others, or a user's circuits in their place."""

import sys
from pathlib import Path
from typing import NamedTuple

from talbot.base.cache import cached, digest
from talbot.base.lef.read import read_macro
from talbot.base.paths import BUILD, ROOT
from talbot.base.sources import code
from talbot.base.tools import run
from talbot.models.parameters import ParameterError
from talbot.platforms.pixel import PROCESSES

from .plan import BLOCKS

KINDS = "lef", "gds"
ARRAY = "pixel_array"
DRAWING = "talbot.pixels.layout.write"
STORE = BUILD / "pixel" / "arrays"


class AnalogFiles(NamedTuple):
    """Files '<block>.lef' and '<block>.gds' by name; blocks that are black boxes; pins that black boxes do not have.

    drawn: blocks that this project draws, and whose cells have checks of their own.
    """

    paths: dict[str, Path]
    black_boxes: list[str]
    extra: tuple[str, ...]
    drawn: tuple[str, ...] = ()


def files(folder: Path, pdk: str, analog: Path | None = None) -> AnalogFiles:
    """Write the black boxes into ``folder``; those of which ``analog`` has LEF and GDS are replaced by these.

    The pixel array is the drawn one where the process has it and the user has no other; the drawing is kept. A pin that
    a black box does not have, a reference or a bias, leads to a pin of the die. Raises ParameterError.
    """
    circuits = _circuits(analog) if analog else []
    run([sys.executable, "-m", "talbot.pixels.footprints", "--pdk", pdk, "--out", folder], cwd=ROOT)
    found = {f"{block}.{kind}": folder / f"{block}.{kind}" for block in BLOCKS for kind in KINDS}
    extra: dict[str, None] = {}
    drawn = (ARRAY,) if pdk in PROCESSES and ARRAY not in circuits else ()
    for block in drawn:
        kept = _drawing(pdk)
        own = {f"{block}.{kind}": kept / f"{block}.{kind}" for kind in KINDS}
        check(own[f"{block}.lef"], found[f"{block}.lef"])
        found |= own
    for block in circuits:
        own = {f"{block}.{kind}": analog / f"{block}.{kind}" for kind in KINDS} if analog else {}
        extra |= dict.fromkeys(check(own[f"{block}.lef"], found[f"{block}.lef"]))
        found |= own
    empty = [block for block in BLOCKS if block not in (*circuits, *drawn)]
    return AnalogFiles(found, empty, tuple(extra), drawn)


def _drawing(pdk: str) -> Path:
    """Folder with LEF and GDS of the pixel array, drawn once."""

    def make(part: Path) -> None:
        run([sys.executable, "-m", DRAWING, "--pdk", pdk, "--out", part], cwd=ROOT)

    return cached(STORE / digest(code(DRAWING), pdk), make)


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


def check(path: Path, black_box: Path) -> list[str]:
    """Names of the pins that only the LEF ``path`` has.

    Raises ParameterError unless it has the pins of ``black_box`` with their directions.
    """
    own, wanted = (
        {pin.name: pin.direction.upper() for pin in read_macro(file.read_text(errors="replace")).pins.values()}
        for file in (path, black_box)
    )
    if lacking := [pin for pin in wanted if pin not in own]:
        more = f" and {len(lacking) - 5} more" if len(lacking) > 5 else ""
        raise ParameterError(f"analog = {path}: must have the pins {', '.join(lacking[:5])}{more}")
    if other := [pin for pin in wanted if own[pin] != wanted[pin]]:
        raise ParameterError(f"analog = {path}: its pin {other[0]} must be of DIRECTION {wanted[other[0]]}")
    return [pin for pin in own if pin not in wanted]
