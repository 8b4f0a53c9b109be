"""Macros as their LEF has them: sizes, pins, antenna areas, obstructions."""

import re
from dataclasses import dataclass

from talbot.models.parameters import ParameterError

Box = tuple[float, float, float, float]  # left, bottom, right, top in um
Shapes = tuple[tuple[str, Box], ...]  # (layer, box)

MACRO = re.compile(r"(?m)^\s*MACRO\s+(\S+)\s*$")
PIN = re.compile(r"(?ms)^\s*PIN\s+(\S+)\s*$(.*?)^\s*END\s+\1\s*$")
OBSTRUCTIONS = re.compile(r"(?ms)^\s*OBS\s*$(.*?)^\s*END\s*$")
SIZE = re.compile(r"(?m)^\s*SIZE\s+(\S+)\s+BY\s+(\S+)\s*;")


@dataclass(frozen=True)
class Pin:
    """A pin of a macro.

    direction, use: as LEF words them, '' where it has none. antenna: keyword -> um2. boxes: in the file's order.
    """

    name: str
    direction: str
    use: str
    antenna: dict[str, float]
    boxes: Shapes

    @property
    def layer(self) -> str:
        """Layer of the first box."""
        return self.boxes[0][0]

    @property
    def x_um(self) -> float:
        """The x of the center of the first box."""
        return round((self.boxes[0][1][0] + self.boxes[0][1][2]) / 2, 3)

    @property
    def y_um(self) -> float:
        """The y of the center of the first box."""
        return round((self.boxes[0][1][1] + self.boxes[0][1][3]) / 2, 3)


@dataclass(frozen=True)
class Macro:
    """A macro; pins: by name, sorted, bits of a bus in their order."""

    name: str
    width_um: float
    height_um: float
    pins: dict[str, Pin]
    obstructions: Shapes


def read_macros(text: str) -> dict[str, Macro]:
    """All macros by name. Raises ParameterError for one without a size."""
    _, *parts = MACRO.split(text)
    return {name: _macro(name, body) for name, body in zip(parts[::2], parts[1::2], strict=True)}


def read_macro(text: str) -> Macro:
    """Return the first macro. Raises ParameterError without one, and for a pin without a rectangle."""
    macro = next(iter(read_macros(text).values()), None)
    if macro is None:
        raise ParameterError("lef = no MACRO: must be the LEF of a macro")
    for pin in macro.pins.values():
        if not pin.boxes:
            raise ParameterError(f"lef = pin {pin.name}: must have a layer and a rectangle")
    return macro


def _macro(name: str, body: str) -> Macro:
    pins = sorted((_pin(*found.groups()) for found in PIN.finditer(body)), key=lambda pin: _natural(pin.name))
    size, obstructions = SIZE.search(body), OBSTRUCTIONS.search(body)
    if not size:
        raise ParameterError(f"lef = macro {name} with no SIZE: must be the LEF of a macro")
    return Macro(
        name,
        float(size[1]),
        float(size[2]),
        {pin.name: pin for pin in pins},
        _boxes(obstructions[1]) if obstructions else (),
    )


def _pin(name: str, body: str) -> Pin:
    direction, use = (re.search(rf"(?m)^\s*{word}\s+(\w+)\s*;", body) for word in ("DIRECTION", "USE"))
    antenna = {}
    for word, area in re.findall(r"(?m)^\s*(ANTENNA\w+AREA)\s+(\S+)", body):
        antenna[word] = antenna.get(word, 0.0) + float(area)
    return Pin(name, direction[1] if direction else "", use[1] if use else "", antenna, _boxes(body))


def _boxes(body: str) -> Shapes:
    """Rectangles that follow a layer."""
    boxes, layer = [], ""
    for word, rest in re.findall(r"(?m)^\s*(LAYER|RECT)\s+(.*?)\s*;", body):
        if word == "LAYER":
            layer = rest
        elif layer:
            left, bottom, right, top = map(float, rest.split())
            boxes.append((layer, (left, bottom, right, top)))
    return tuple(boxes)


def _natural(name: str) -> list[int | str]:
    return [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", name)]
