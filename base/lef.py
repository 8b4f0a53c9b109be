"""Size and pins of a macro as its LEF has them."""

import re
from dataclasses import dataclass

from models.parameters import ParameterError

PIN = re.compile(r"(?ms)^\s*PIN\s+(\S+)\s*$(.*?)^\s*END\s+\1\s*$")


@dataclass(frozen=True)
class Pin:
    """name; direction and use as LEF words them; boxes: tuple of (layer, (left, bottom, right, top)), um. layer, x_um,
    y_um: of the first of them, its centre."""

    name: str
    direction: str
    use: str
    boxes: tuple

    @property
    def layer(self):
        return self.boxes[0][0]

    @property
    def x_um(self):
        return round((self.boxes[0][1][0] + self.boxes[0][1][2]) / 2, 3)

    @property
    def y_um(self):
        return round((self.boxes[0][1][1] + self.boxes[0][1][3]) / 2, 3)


def name(text):
    """Of the first macro. Raises ParameterError."""
    found = re.search(r"(?m)^\s*MACRO\s+(\S+)\s*$", text)
    if not found:
        raise ParameterError("lef = no MACRO: must be the LEF of a macro")
    return found[1]


def size(text):
    """(width, height) in um of the first macro. Raises ParameterError."""
    found = re.search(r"(?m)^\s*SIZE\s+(\S+)\s+BY\s+(\S+)\s*;", text)
    if not found:
        raise ParameterError("lef = no SIZE: must be the LEF of a macro")
    return float(found[1]), float(found[2])


def pins(text):
    """Every Pin, sorted by name, bits of a bus in their order. Raises ParameterError for one without a rectangle."""
    return sorted((_pin(*match.groups()) for match in PIN.finditer(text)), key=lambda pin: _natural(pin.name))


def _pin(name, body):
    words = (re.search(rf"(?m)^\s*{word}\s+(\w+)\s*;", body) for word in ("DIRECTION", "USE"))
    boxes, layer = [], None
    for word, said in re.findall(r"(?m)^\s*(LAYER|RECT)\s+(.*?)\s*;", body):
        if word == "LAYER":
            layer = said
        else:
            boxes.append((layer, tuple(map(float, said.split()))))
    if not boxes or boxes[0][0] is None:
        raise ParameterError(f"lef = pin {name}: must have a layer and a rectangle")
    return Pin(name, *(found[1] if found else "" for found in words), tuple(boxes))


def _natural(name):
    return [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", name)]
