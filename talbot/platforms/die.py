"""Process data of a die beyond the blocks' metals: the thick metal above them, the seal ring at the edge."""

from dataclasses import dataclass
from importlib import import_module
from typing import NamedTuple

from talbot.platforms.layers import GdsLayer, Layer, Via
from talbot.platforms.processes import package

PROCESSES = ("sky130",)


@dataclass(frozen=True)
class TopMetal:
    """The metal above the highest of LayoutPlatform.metals, and the via between the two."""

    metal: Layer
    via: Via


class Ring(NamedTuple):
    """A closed ring on a layer. inset_um: from the die's edge to its outside; width_um: of the ring."""

    gds: GdsLayer
    inset_um: float
    width_um: float


@dataclass(frozen=True)
class SealRing:
    """Walls of every conductor and cut around a die, which keep moisture and cracks out.

    rings: of all layers but the contacts, which are rows of squares as wide as their ring, a width apart, and end at
    the chamfers. corner_um: x + y of the chamfer of a ring at ``inset_um``, from the die's corner.
    """

    rings: tuple[Ring, ...]
    contacts: tuple[Ring, ...]
    inset_um: float
    corner_um: float


def top_metal(pdk: str) -> TopMetal:
    """Return the top metal of ``pdk``. Raises ParameterError for a process without one."""
    return import_module(f"talbot.platforms.{package(pdk, PROCESSES, ' for a whole die')}.layers").TOP


def seal_ring(pdk: str) -> SealRing:
    """Return the seal ring of ``pdk``. Raises ParameterError for a process without one."""
    return import_module(f"talbot.platforms.{package(pdk, PROCESSES, ' for a whole die')}.layers").SEAL
