"""Process data of a drawn pixel: masks of its transistors and wells, contacts, rules that no deck has."""

from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from types import ModuleType

from talbot.models.parameters import ParameterError
from talbot.platforms.layers import GdsLayer, Layer, Via
from talbot.platforms.processes import package

PROCESSES = ("sky130",)


@dataclass(frozen=True, kw_only=True)
class PixelProcess:
    """Masks and devices of a pixel: an n well in the p substrate as the photodiode, thick-oxide n transistors.

    name: of the process. active, tap, well, nplus, pplus, poly, contact, contact_poly: masks; tap is the diffusion of
    contacts to wells and substrate, contact_poly opens the nitride around contacts to poly. thick: (mask, enclosure of
    the transistors' active area in um) of each mask that makes them thick-oxide ones. metals, vias: as in
    `LayoutPlatform`, with the top metal and the via below it. outline: mask of a cell's outline. fill_blocks: masks
    that keep a shuttle's fill out. transistor, diode: SPICE models. supply_v: of pixels; gate_v: of their reset and
    select lines, above the supply by more than a threshold, so that a reset is complete. masks: rules of KLayout for
    these masks. density_most: limit of a metal's share. deck_model, deck_diode: names of the devices in LVS.
    """

    name: str
    active: GdsLayer
    tap: GdsLayer
    well: GdsLayer
    nplus: GdsLayer
    pplus: GdsLayer
    poly: GdsLayer
    contact: GdsLayer
    contact_poly: GdsLayer
    thick: tuple[tuple[GdsLayer, float], ...]
    metals: tuple[Layer, ...]
    vias: tuple[Via, ...]
    outline: GdsLayer
    fill_blocks: tuple[GdsLayer, ...]
    grid_um: float
    transistor: str
    diode: str
    deck_model: str
    deck_diode: str
    supply_v: float
    gate_v: float
    masks: Path
    lvs: Path
    density_most: float

    def level(self, name: str) -> int:
        """Place of the metal with this LEF name among ``metals``. Raises ParameterError."""
        names = [metal.lef for metal in self.metals]
        if name not in names:
            raise ParameterError(f"metal = {name!r}: must be one of {', '.join(names)}, metals of {self.name}")
        return names.index(name)


def pixel_process(pdk: str) -> PixelProcess:
    """Return the process ``pdk`` for pixels. Raises ParameterError for one whose pixels are not drawn."""
    return import_module(f"talbot.platforms.{package(pdk, PROCESSES, ' for a drawn pixel')}.pixel").PROCESS


def pixel_models(pdk: str) -> ModuleType:
    """The process's SPICE models of a pixel: a module like `platforms.sky130.photodiode`. Raises ParameterError."""
    return import_module(f"talbot.platforms.{package(pdk, PROCESSES, ' for a drawn pixel')}.photodiode")
