"""Just as much of LEF as it takes to compare two macros: sizes, pins, rectangles, antenna areas."""

import re
from dataclasses import dataclass, field


@dataclass
class MacroPin:
    """direction, use; antenna: keyword -> um2; shapes: layer -> list of (left, bottom, right, top), um."""

    direction: str = ""
    use: str = ""
    antenna: dict = field(default_factory=dict)
    shapes: dict = field(default_factory=dict)


@dataclass
class Macro:
    """size: (width, height) um; pins: name -> MacroPin; obstructions: layer -> list of rectangles."""

    size: tuple = ()
    pins: dict = field(default_factory=dict)
    obstructions: dict = field(default_factory=dict)


def read(text):
    """name -> Macro of a LEF text."""
    macros, macro, pin, shapes, layer = {}, None, None, None, None
    for words in (line.replace(";", " ").split() for line in text.splitlines()):
        key = words[0] if words else ""
        if key == "MACRO":
            macro = macros[words[1]] = Macro()
        elif macro is None:
            continue
        elif key == "SIZE":
            macro.size = float(words[1]), float(words[3])
        elif key == "PIN":
            pin = macro.pins[words[1]] = MacroPin()
            shapes = pin.shapes
        elif key == "OBS":
            shapes = macro.obstructions
        elif key == "DIRECTION":
            pin.direction = words[1]
        elif key == "USE":
            pin.use = words[1]
        elif re.fullmatch(r"ANTENNA\w+AREA", key):
            pin.antenna[key] = pin.antenna.get(key, 0.0) + float(words[1])
        elif key == "LAYER" and shapes is not None:
            layer = words[1]
        elif key == "RECT":
            shapes.setdefault(layer, []).append(tuple(map(float, words[1:5])))
    return macros
