"""A block that was laid out before, as one that holds it sees it: size, pins and straps, from its LEF."""

import re
from dataclasses import dataclass
from pathlib import Path

from flow.platforms import openroad
from models.parameters import ParameterError

from .abstract import EDGE_UM
from .netlist import SUPPLIES


def layer_names(pdk):
    """dict (GDS layer, datatype) -> name of the layer in LEF, where it is not that of the wire."""
    known = openroad.process(pdk).gds if pdk in openroad.PROCESSES else {}
    return {numbers: name for name, numbers in known.items()}


@dataclass(frozen=True)
class Macro:
    """name: of module and cell. pins: dict pin -> (direction in lower case, wire, (left, bottom, right, top)), of
    its pieces on the west or the east edge the one that is farthest from other pins. straps: pairs (supply, x), from the west on. All in um."""

    name: str
    width_um: float
    height_um: float
    pins: dict
    straps: tuple

    @classmethod
    def read(cls, path, known, names):
        """From a LEF as the step `lef` writes it. known: Embedded; names: see `layer_names`. Raises ParameterError."""
        text = Path(path).read_text()
        size = re.search(r"(?m)^MACRO (\S+)$.*?^ +SIZE (\S+) BY (\S+) ;", text, re.S | re.M)
        if not size:
            raise ParameterError(f"lef = {path}: must have a MACRO with a SIZE")
        wires = {names.get((wire.layer, wire.datatype), wire.name): wire.name for wire in known.wires}
        pieces, straps = {}, []
        for name, body in re.findall(r"(?ms)^  PIN (\S+)$(.*?)^  END \1$", text):
            boxes = [(wires[layer], tuple(map(float, corners.split()))) for layer, corners in
                     re.findall(r"LAYER (\S+) ;\s+RECT ([-\d. ]+) ;", body)]
            if name in SUPPLIES:
                straps += [((box[0] + box[2]) / 2, name) for _, box in boxes]
            else:
                pieces[name] = re.search(r"DIRECTION (\w+) ;", body)[1].lower(), boxes
        pins = {name: (direction, *_best(boxes, [box for other, (_, more) in pieces.items() if other != name
                                                 for _, box in more])) for name, (direction, boxes) in pieces.items()}
        return cls(size[1], float(size[2]), float(size[3]), pins, tuple((net, x) for x, net in sorted(straps)))


def _best(boxes, others):
    """Of pairs (wire, box) of one pin that which ends at the edge, not one along it, and is farthest from others."""
    def rank(piece):
        left, bottom, right, top = piece[1]
        away = min((abs(bottom + top - low - high) for west, low, east, high in others if (west <= 0) == (left <= 0)),
                   default=0)
        return top - bottom < 2 * EDGE_UM, round(away, 3), right - left
    return max(boxes, key=rank)
