"""A block that was laid out before, as one that holds it sees it: size, pins and straps, from its LEF."""

from dataclasses import dataclass
from pathlib import Path

from base import lef
from flow.layout.netlist.netlist import SUPPLIES

from .abstract import EDGE_UM


@dataclass(frozen=True)
class Macro:
    """name: of module and cell. pins: dict pin -> (direction in lower case, wire, (left, bottom, right, top)), of its
    pieces on the west or the east edge the one that is farthest from other pins. straps: pairs (supply, x), from the
    west on. All in um."""

    name: str
    width_um: float
    height_um: float
    pins: dict
    straps: tuple

    @classmethod
    def read(cls, path, known):
        """From a LEF as the step `lef` writes it. Raises ParameterError."""
        text = Path(path).read_text()
        wires = {wire.lef: wire.name for wire in known.metals}
        found = {pin.name: pin for pin in lef.pins(text)}
        straps = sorted(((box[0] + box[2]) / 2, net) for net in SUPPLIES for _, box in found[net].boxes)
        pieces = {
            pin: [(wires[layer], box) for layer, box in made.boxes]
            for pin, made in found.items()
            if pin not in SUPPLIES
        }
        pins = {
            pin: (
                found[pin].direction.lower(),
                *_best(boxes, [box for other in pieces if other != pin for _, box in pieces[other]]),
            )
            for pin, boxes in pieces.items()
        }
        return cls(lef.name(text), *lef.size(text), pins, tuple((net, round(x, 4)) for x, net in straps))


def _best(boxes, others):
    """Of pairs (wire, box) of one pin that which ends at the edge, not one along it, and is farthest from others."""

    def rank(piece):
        left, bottom, right, top = piece[1]
        away = min(
            (abs(bottom + top - low - high) for west, low, east, high in others if (west <= 0) == (left <= 0)),
            default=0,
        )
        return top - bottom < 2 * EDGE_UM, round(away, 3), right - left

    return max(boxes, key=rank)
