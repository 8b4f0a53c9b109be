"""Size and pins of a macro as its LEF has them."""

import re
from dataclasses import dataclass

from models.parameters import ParameterError

PIN = re.compile(r"(?ms)^\s*PIN\s+(\S+)\s*$(.*?)^\s*END\s+\1\s*$")


@dataclass(frozen=True)
class Pin:
    """name; direction and use as LEF words them; layer; x_um, y_um: centre of its first rectangle."""

    name: str
    direction: str
    use: str
    layer: str
    x_um: float
    y_um: float


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
    words = {word: re.search(rf"(?m)^\s*{word}\s+(\w+)\s*;", body) for word in ("DIRECTION", "USE", "LAYER")}
    box = re.search(r"(?m)^\s*RECT\s+(\S+)\s+(\S+)\s+(\S+)\s+(\S+)\s*;", body)
    if not (box and words["LAYER"]):
        raise ParameterError(f"lef = pin {name}: must have a layer and a rectangle")
    x0, y0, x1, y1 = map(float, box.groups())
    return Pin(name, *(words[word][1] if words[word] else "" for word in ("DIRECTION", "USE", "LAYER")),
               round((x0 + x1) / 2, 3), round((y0 + y1) / 2, 3))


def _natural(name):
    return [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", name)]
