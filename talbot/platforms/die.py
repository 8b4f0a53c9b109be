"""Process data of a die beyond the blocks' metals: the thick metal above them."""

from dataclasses import dataclass
from importlib import import_module

from talbot.platforms.layers import Layer, Via
from talbot.platforms.processes import package

PROCESSES = ("sky130",)


@dataclass(frozen=True)
class TopMetal:
    """The metal above the highest of LayoutPlatform.metals, and the via between the two."""

    metal: Layer
    via: Via


def top_metal(pdk: str) -> TopMetal:
    """Return the top metal of ``pdk``. Raises ParameterError for a process without one."""
    return import_module(f"talbot.platforms.{package(pdk, PROCESSES, ' for a whole die')}.layers").TOP
