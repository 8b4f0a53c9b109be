"""Process data of `cells.extract` and `cells.lef`: layers, coefficients and names of device models."""

from collections.abc import Callable, Collection
from dataclasses import dataclass
from importlib import import_module
from types import ModuleType

from talbot.platforms.layers import Crossing, GdsLayer, Layer, Via
from talbot.platforms.processes import package


@dataclass(frozen=True)
class ExtractionPlatform:
    """A process for extraction.

    conductors: poly and the cells' metals, from the lowest. vias: the contact first. halo_um: reach of fringe fields.
    devices: name -> GDS layer of what makes transistors (active, taps, wells, implants, threshold marks); a process
    without a separate layer for taps, n implants or marks leaves these out. outlines: GDS layers that may hold a
    cell's outline. well_labels: GDS layers of the names of n well and p substrate. contact_ohm: of one contact or via
    by what is below it: 'n', 'p' (diffusion) or a conductor's LEF name. model: name of the transistor model, from its
    kind ('n' or 'p'), its width (um) and the marks over its gate.
    """

    conductors: tuple[Layer, ...]
    crossings: tuple[Crossing, ...]
    vias: tuple[Via, ...]
    devices: dict[str, GdsLayer]
    outlines: tuple[GdsLayer, ...]
    well_labels: tuple[GdsLayer, ...]
    halo_um: float
    contact_ohm: dict[str, float]
    model: Callable[[str, float, Collection[str]], str]

    def conductor(self, name: str) -> Layer:
        """Return the conductor with the LEF name ``name``."""
        return next(layer for layer in self.conductors if layer.lef == name)


def extraction_platform(pdk: str) -> ExtractionPlatform:
    """Return the process ``pdk`` for extraction. Raises ParameterError."""
    return import_module(f"talbot.platforms.{package(pdk)}.extraction").PLATFORM


def device_models(pdk: str) -> ModuleType:
    """Module with the device models (POLARITY, SUPPLIES, ...) of ``pdk``, for `cells`. Raises ParameterError."""
    return import_module(f"talbot.platforms.{package(pdk)}.models")
