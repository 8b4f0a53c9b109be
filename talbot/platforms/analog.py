"""Process data of drawn analog circuits beyond the pixels': thresholds, capacitors, names."""

from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

from talbot.models.parameters import check_real
from talbot.platforms.layers import GdsLayer
from talbot.platforms.pixel import PROCESSES, PixelProcess
from talbot.platforms.processes import package


@dataclass(frozen=True, kw_only=True)
class AnalogMasks:
    """Masks and devices of analog circuits.

    base: what pixels are drawn with. low_threshold: mask over the gates of the roles in ``low``. models: name of the
    device in LVS by role. mim: mask of the capacitor's upper plate, over metal ``mim_metal`` of ``base.metals``.
    mim_area, mim_edge: fF/um2, fF/um. fringe: mark at the tip of a finger of the two lowest metals between two others.
    fringe_side_um: of the square that LVS counts as a unit. fringe_um: fF for a um of it, typical. fringe_end: fF of
    its end. fringe_share: what such fingers have, of what rays give. deck_mim, deck_fringe: these capacitors in LVS.
    resistor: mask over the body of a resistor of n+ diffusion of ``sheet_ohm``, typical. deck_resistor: its device in
    LVS. rules, thick (of thick oxide), lvs: what the decks of PDKMaster lack. connections: lines of its
    deck of LVS and what replaces them.
    """

    base: PixelProcess
    low_threshold: GdsLayer
    low: frozenset[str]
    models: Mapping[str, str]
    mim: GdsLayer
    mim_metal: int
    mim_area: float
    mim_edge: float
    fringe: GdsLayer
    fringe_side_um: float
    fringe_um: float
    fringe_end: float
    fringe_share: float
    deck_mim: str
    deck_fringe: str
    resistor: GdsLayer
    sheet_ohm: float
    deck_resistor: str
    rules: Path
    thick: Path
    lvs: Path
    connections: Mapping[str, str]

    def mim_farad(self, width_um: float, height_um: float) -> float:
        """Return the typical capacitance of a capacitor, F."""
        return 1e-15 * (self.mim_area * width_um * height_um + self.mim_edge * 2 * (width_um + height_um))

    def finger_um(self, farad: float) -> float:
        """Length of a finger that is a capacitor of ``farad``, on a grid of 0.01 um. Raises ParameterError."""
        length = round((farad * 1e15 - self.fringe_end) / self.fringe_um, 2)
        check_real("unit", length, 1.0, 100.0)
        return length


def analog_masks(pdk: str) -> AnalogMasks:
    """The process ``pdk`` for drawn analog circuits. Raises ParameterError for one whose circuits are not drawn."""
    return import_module(f"talbot.platforms.{package(pdk, PROCESSES, ' for a drawn circuit')}.analog_masks").MASKS
