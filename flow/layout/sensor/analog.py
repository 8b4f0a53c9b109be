"""Files of the analog blocks: those that this project draws, black boxes, or a user's circuits in their place."""

import sys
from collections.abc import Callable, Mapping, Sequence
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
# Modules that write the drawn blocks, and these
CIRCUITS = "row_driver", "column_amplifiers", "adc_lanes"
DRAWINGS = {"talbot.pixels.layout.write": (ARRAY,), "talbot.flow.analog_layout.write": CIRCUITS}
STORE = BUILD / "drawn"


class AnalogFiles(NamedTuple):
    """Files '<block>.lef' and '<block>.gds' by name; blocks that are black boxes; pins that black boxes do not have.

    drawn: blocks that this project draws, and whose cells have checks of their own.
    """

    paths: dict[str, Path]
    black_boxes: list[str]
    extra: tuple[str, ...]
    drawn: tuple[str, ...] = ()


def files(
    folder: Path,
    pdk: str,
    analog: Path | None = None,
    note: Callable[[str], None] = lambda text: None,
    drawings: Mapping[str, Sequence[str]] = DRAWINGS,
) -> AnalogFiles:
    """Write the black boxes into ``folder``; those of which ``analog`` has LEF and GDS are replaced by these.

    Where the process has drawn pixels and the user no other, blocks that this project draws are these; they are kept. A
    pin that a black box does not have, a reference or a bias, leads to a pin of the die. Raises ParameterError.
    """
    circuits = _circuits(analog) if analog else []
    run([sys.executable, "-m", "talbot.pixels.footprints", "--pdk", pdk, "--out", folder], cwd=ROOT)
    found = {f"{block}.{kind}": folder / f"{block}.{kind}" for block in BLOCKS for kind in KINDS}
    modules = {block: module for module, blocks in drawings.items() for block in blocks if pdk in PROCESSES}
    drawn = tuple(block for block in BLOCKS if block in modules and block not in circuits)
    places = {block: _drawing(modules[block], drawings[modules[block]], pdk, note) for block in drawn}
    if analog:
        places |= dict.fromkeys(circuits, analog)
    extra: dict[str, None] = {}
    for block in BLOCKS:
        if block in places:
            own = {f"{block}.{kind}": places[block] / f"{block}.{kind}" for kind in KINDS}
            extra |= dict.fromkeys(check(own[f"{block}.lef"], found[f"{block}.lef"]))
            found |= own
    empty = [block for block in BLOCKS if block not in places]
    return AnalogFiles(found, empty, tuple(extra), drawn)


def _drawing(module: str, blocks: Sequence[str], pdk: str, note: Callable[[str], None]) -> Path:
    """Folder with LEF and GDS of ``blocks``, which ``module`` draws, and compares with their circuits, once."""

    def make(part: Path) -> None:
        note(f"drawing {', '.join(blocks)}")
        run([sys.executable, "-m", module, "--pdk", pdk, "--out", part], cwd=ROOT)

    return cached(STORE / digest(code(module), pdk), make)


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
