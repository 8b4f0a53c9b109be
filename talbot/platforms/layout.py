"""Process data of the layout flow (KLayout and the steps of flow.layout): one object a process."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path

from talbot.models.parameters import ParameterError
from talbot.platforms.frame import Frame
from talbot.platforms.layers import GdsLayer, Layer, Via
from talbot.platforms.processes import package
from talbot.platforms.wires import Wires


@dataclass(frozen=True)
class Fill:
    """Metal fill, which belongs to no net.

    width_um, area_um2, side_um: of a shape, the least width and area, and the largest side. clearances_um: by metal, of
    a shape to all other metal; the next is tried where the one before leaves too little room. density: share of a layer
    that is to be covered. density_least, density_most: limits of each layer in every window of window_um.
    """

    width_um: float
    area_um2: float
    side_um: float
    clearances_um: Mapping[str, tuple[float, ...]]
    density: float
    density_least: float
    density_most: float
    window_um: float


@dataclass(frozen=True)
class Dummies:
    """Shapes of no net in the cells that fill rows, for the density of the lowest layers.

    implants, taps: GDS layers. insets_um: by GDS layer, how much smaller than an implant a shape is on each side, in x
    and in y.
    """

    implants: tuple[GdsLayer, ...]
    taps: GdsLayer
    insets_um: Mapping[GdsLayer, tuple[float, float]]


@dataclass(frozen=True)
class LayoutPlatform:
    """A process for the layout flow.

    package, wheel: Python package of PDKMaster's description, and its distribution. row_um, site_um, grid_um: cell
    height, placement grid, manufacturing grid. supply_v: volts. fill_cells: cells of no function for empty places.
    metals: from the cells' pins up; vias[k] connects metals[k] and metals[k + 1]; straps run on the last metal,
    strap_um wide, and meet a rail over rail_overlap_um; a rail, on metals[rail], is rail_um wide, half of that at the
    edge. pin_pitch_um: tracks of the pins' two layers, 'horizontal' (west and east) and 'vertical'. label_datatype,
    pin_datatype: GDS datatypes of labels and of what the decks take for pins. outline: GDS layer of the die's.
    blockage_layer: of GDS, to drop. poly, active, contact: GDS layers, the last between the first two and the lowest
    metal. tap: mask of taps; None where it is that of active. fill: of all metals but the lowest. dummies: of the
    others. wires: by platforms.wires.CORNERS. corners: at which cells are timed, that of synthesis first; () where
    there are no models of the devices. antenna_walls: whether antenna ratios are those of side walls, else of area.
    masks: rules of KLayout beyond those of PDKMaster's deck. lvs: what its deck of LVS lacks. contradicted: rules of
    its deck that SkyWater's own transistors break. frames: outlines of shuttles, by name.
    """

    name: str
    package: str
    wheel: str
    row_um: float
    site_um: float
    grid_um: float
    supply_v: float
    fill_cells: tuple[str, ...]
    metals: tuple[Layer, ...]
    vias: tuple[Via, ...]
    strap_um: float
    rail_um: float
    rail_overlap_um: float
    pin_pitch_um: dict[str, float]
    label_datatype: int
    pin_datatype: int
    outline: GdsLayer
    blockage_layer: int
    poly: GdsLayer
    active: GdsLayer
    contact: GdsLayer
    fill: Fill
    wires: Mapping[str, Wires]
    corners: tuple[str, ...] = ()
    rail: int = 0
    tap: GdsLayer | None = None
    dummies: Dummies | None = None
    masks: Path | None = None
    lvs: Path | None = None
    contradicted: tuple[str, ...] = ()
    antenna_walls: bool = True
    frames: Mapping[str, Frame] = field(default_factory=dict)

    def frame(self, name: str) -> Frame:
        """Look up a Frame. Raises ParameterError."""
        if name not in self.frames:
            raise ParameterError(f"pdk = {self.name!r}: must have the frame {name}")
        return self.frames[name]


def layout_platform(pdk: str) -> LayoutPlatform:
    """Return the process ``pdk`` for the layout flow. Raises ParameterError."""
    return import_module(f"talbot.platforms.{package(pdk)}.layout").PLATFORM
