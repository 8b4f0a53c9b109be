"""What a whole die needs of a process beyond the blocks' metals: the thick metal above them."""

from dataclasses import dataclass
from importlib import import_module

from .layers import GdsLayer, Layer, Via
from .processes import package

PROCESSES = ("sky130",)


@dataclass(frozen=True)
class TopMetal:
    """The metal above the highest of CoriolisPlatform.metals, and the via between the two."""

    metal: Layer
    via: Via


@dataclass(frozen=True)
class Capacitor:
    """A capacitor below the highest via of CoriolisPlatform.vias: its top plate over the metal below that.

    plate: GDS layer and datatype of the top plate, which that via contacts. area_ff_um2, edge_ff_um: typical.
    """

    plate: GdsLayer
    area_ff_um2: float
    edge_ff_um: float


def capacitor(pdk: str) -> Capacitor:
    """The capacitor of ``pdk`` for decoupling. Raises ParameterError for a process without one."""
    return import_module(f"talbot.platforms.{package(pdk, PROCESSES, ' for a whole die')}.layers").CAPACITOR


def top_metal(pdk: str) -> TopMetal:
    """The top metal of ``pdk``. Raises ParameterError for a process without one."""
    return import_module(f"talbot.platforms.{package(pdk, PROCESSES, ' for a whole die')}.layers").TOP
