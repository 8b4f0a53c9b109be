"""Process data of a die's pads: the factory that draws them, and the masks that it lacks."""

from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from types import ModuleType

from talbot.platforms.layers import GdsLayer
from talbot.platforms.processes import package

PROCESSES = ("sky130",)


@dataclass(frozen=True)
class Capacitor:
    """A capacitor for decoupling: a top plate over the metal below the highest via of LayoutPlatform.vias.

    plate: GDS layer and datatype of the top plate, which that via contacts. area_ff_um2, edge_ff_um: typical.
    """

    plate: GdsLayer
    area_ff_um2: float
    edge_ff_um: float


@dataclass(frozen=True, kw_only=True)
class PadProcess:
    """Pads of a process, drawn by c4m-flexio.

    package: of PDKMaster. module: its pads. drawing, factory: the module and in it the class that draws those of a die.
    cells: what a die uses, by the factory's names.
    signals: function -> its cell. fillers: their cells by width in um, the widest first. width_um, height_um: of
    a pad, its bond pad in the south. tap: mask of taps. bond: of the opening over a bond pad. masks: rules of KLayout
    for the masks that are added. capacitor: for decoupling. pad_v, core_v: supplies.
    """

    package: str
    module: str
    drawing: str
    factory: str
    signals: Mapping[str, str]
    supplies: Mapping[str, str]
    corner: str
    fillers: Mapping[float, str]
    width_um: float
    height_um: float
    tap: GdsLayer
    bond: GdsLayer
    masks: Path
    capacitor: Capacitor
    pad_v: float
    core_v: float

    @property
    def cells(self) -> list[str]:
        """All cells."""
        return [*self.signals.values(), *self.supplies.values(), self.corner, *self.fillers.values()]


def pad_process(pdk: str) -> PadProcess:
    """Return the pads of ``pdk``. Raises ParameterError for a process without them."""
    return import_module(f"talbot.platforms.{package(pdk, PROCESSES, ' for a die with pads')}.pads").PROCESS


def esd_models(pdk: str) -> ModuleType:
    """Pads for ngspice: a module like `platforms.sky130.esd`. Raises ParameterError for a process without them."""
    return import_module(f"talbot.platforms.{package(pdk, PROCESSES, ' for a die with pads')}.esd")
