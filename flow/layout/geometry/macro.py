"""A block that was laid out before, as one that contains it sees it: size, pins and straps, from its LEF."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from talbot.base.lef.read import Box, read_macro
from talbot.flow.layout.netlist.netlist import SUPPLIES
from talbot.platforms.coriolis import CoriolisPlatform

from .abstract import EDGE_UM


class MacroPin(NamedTuple):
    """A pin; direction: in lower case. metal: its name in Coriolis. box: um."""

    direction: str
    metal: str
    box: Box


@dataclass(frozen=True)
class Macro:
    """A laid-out block; all in um.

    name: of module and cell. pins: of a pin's pieces on the west or the east edge the one that is farthest from other
    pins. straps: pairs (supply, x), from the west on.
    """

    name: str
    width_um: float
    height_um: float
    pins: dict[str, MacroPin]
    straps: tuple[tuple[str, float], ...]

    @classmethod
    def read(cls, path: str | Path, tech: CoriolisPlatform) -> "Macro":
        """From a LEF as the step `lef` writes it. Raises ParameterError."""
        found = read_macro(Path(path).read_text(encoding="utf-8"))
        names = {metal.lef: metal.name for metal in tech.metals}
        straps = sorted(((box[0] + box[2]) / 2, net) for net in SUPPLIES for _, box in found.pins[net].boxes)
        pins = {name: pin for name, pin in found.pins.items() if name not in SUPPLIES}
        best = {}
        for name, pin in pins.items():
            others = [box for other, of in pins.items() if other != name for _, box in of.boxes]
            layer, box = _best(pin.boxes, others)
            best[name] = MacroPin(pin.direction.lower(), names[layer], box)
        supplies = tuple((net, round(x, 4)) for x, net in straps)
        return cls(found.name, found.width_um, found.height_um, best, supplies)


def _best(pieces: Sequence[tuple[str, Box]], others: Sequence[Box]) -> tuple[str, Box]:
    """Of a pin's pieces (layer, box) that which ends at the edge, not one along it, and is farthest from others."""

    def rank(piece: tuple[str, Box]) -> tuple[bool, float, float]:
        left, bottom, right, top = piece[1]
        gaps = (abs(bottom + top - low - high) for west, low, _, high in others if (west <= 0) == (left <= 0))
        return top - bottom < 2 * EDGE_UM, round(min(gaps, default=0), 3), right - left

    return max(pieces, key=rank)
