"""Talbot: angle-sensitive-pixel image sensors, from the light field to the bytes of the chip's Verilog and back.

    sensor = talbot.Sensor(rows=64, cols=96, m=0.5)
    run = sensor.simulate(talbot.LightField.load("views/"), mode="raw")
    run.reconstruct("light_field")

Everything is loaded when it is first used. Objects show themselves as pictures in a notebook. What is out of range
raises ParameterError: one line with the field, the value and the range.
"""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from talbot.api import pixel
    from talbot.api.decode import DecodedFrame, decode
    from talbot.api.explore import Exploration, explore
    from talbot.api.image import Image
    from talbot.api.light_field import LightField
    from talbot.api.recognize import Recognition, recognize
    from talbot.api.run import Run
    from talbot.api.sensor import Sensor, scenes
    from talbot.api.sweep import Tradeoff, tradeoff
    from talbot.base.tools import ToolError
    from talbot.models.parameters import ParameterError, PixelType

__all__ = [
    "DecodedFrame",
    "Exploration",
    "Image",
    "LightField",
    "ParameterError",
    "PixelType",
    "Recognition",
    "Run",
    "Sensor",
    "ToolError",
    "Tradeoff",
    "decode",
    "explore",
    "pixel",
    "recognize",
    "scenes",
    "tradeoff",
]

_MODULES = {
    "DecodedFrame": "talbot.api.decode",
    "Exploration": "talbot.api.explore",
    "Image": "talbot.api.image",
    "LightField": "talbot.api.light_field",
    "ParameterError": "talbot.models.parameters",
    "PixelType": "talbot.models.parameters",
    "Recognition": "talbot.api.recognize",
    "Run": "talbot.api.run",
    "Sensor": "talbot.api.sensor",
    "ToolError": "talbot.base.tools",
    "Tradeoff": "talbot.api.sweep",
    "decode": "talbot.api.decode",
    "explore": "talbot.api.explore",
    "pixel": "talbot.api.pixel",
    "recognize": "talbot.api.recognize",
    "scenes": "talbot.api.sensor",
    "tradeoff": "talbot.api.sweep",
}


def __getattr__(name: str) -> Any:
    if name not in _MODULES:
        raise AttributeError(f"module 'talbot' has no attribute {name!r}")
    module = importlib.import_module(_MODULES[name])
    value = globals()[name] = getattr(module, name, module)  # talbot.pixel is a module itself
    return value


def __dir__() -> list[str]:
    return [*__all__]
