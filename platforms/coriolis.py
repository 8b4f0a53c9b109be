"""What the embedded backend (Coriolis, KLayout) must know of a process: one object a process."""

import importlib
from dataclasses import dataclass

from models.parameters import ParameterError

PROCESSES = "sky130", "ihp-sg13g2"


@dataclass(frozen=True)
class Wire:
    """A wiring layer: its name in PDKMaster, GDS layer and datatype, capacitance to the ground plane (aF/um2, aF/um
    of edge), resistance (Ohm per square), thickness (um), and the most side wall by gate area: antenna_ratio on a net
    without a diffusion, else antenna_diffusion[0] plus antenna_diffusion[1] an um2 of it; least area of a hole in it,
    where PDKMaster's rules have none of that."""

    name: str
    layer: int
    datatype: int
    area_af_um2: float
    edge_af_um: float
    ohm: float
    thickness_um: float
    antenna_ratio: float
    antenna_diffusion: tuple
    hole_um2: float = 0.0


@dataclass(frozen=True)
class Cut:
    """Between two wires: name, GDS layer and datatype, size, space and enclosure by the wires (um), Ohm of one."""

    name: str
    layer: int
    datatype: int
    size_um: float
    space_um: float
    enclosure_um: float
    ohm: float


@dataclass(frozen=True)
class Fill:
    """Metal that belongs to no net: sides of its squares (um, the largest first), their space to one another and to
    wires (um), and the share of a layer that is to be covered, where there is room. density_most: of a layer, all metal
    counted, in every window of window_um."""

    sides_um: tuple
    space_um: float
    clearance_um: float
    density: float
    density_most: float
    window_um: float


@dataclass(frozen=True)
class Embedded:
    """name: of the process. package, wheel: Python package of PDKMaster's description, and its distribution.

    row_um, site_um, grid_um: cell height, placement grid, manufacturing grid. supply_v: volts. fill_cells: cells of no
    function for empty places. wires: from the cells' rails up; cuts[i] joins wires[i] and wires[i + 1]; straps run on
    the last wire, strap_um wide, and meet a rail over rail_overlap_um; a rail on the lowest wire is
    rail_um wide, half of that at the edge. pin_pitch_um: tracks of the pins' two layers,
    'horizontal' (west and east) and 'vertical'. label_datatype,
    pin_datatype: GDS datatypes of a wire's labels and of what the decks take for pins. blockage_layer: of GDS, to drop.
    poly, active, contact: (GDS layer, datatype), the last between the first two and the lowest wire. fill: Fill, of all
    wires but the lowest. corners: at which cells are timed, that of synthesis first; () where there are no models of
    the devices. antenna_walls: whether antenna ratios are those of a wire's side walls, else of its area.
    """

    name: str
    package: str
    wheel: str
    row_um: float
    site_um: float
    grid_um: float
    supply_v: float
    fill_cells: tuple
    wires: tuple
    cuts: tuple
    strap_um: float
    rail_um: float
    rail_overlap_um: float
    pin_pitch_um: dict
    label_datatype: int
    pin_datatype: int
    blockage_layer: int
    poly: tuple
    active: tuple
    contact: tuple
    fill: Fill
    corners: tuple = ()
    antenna_walls: bool = True


def process(pdk):
    """(Embedded, function that makes the PDKMaster library) of ``pdk``. Raises ParameterError."""
    if pdk not in PROCESSES:
        raise ParameterError(f"pdk = {pdk!r}: must be one of {', '.join(PROCESSES)}")
    module = importlib.import_module(f"platforms.{pdk.replace('-', '_')}.coriolis")
    return module.PROCESS, module.library


def modules(pdk):
    """Modules with the device models (POLARITY, SUPPLIES ...) and the layers (PROCESS) of ``pdk``, for `cells`."""
    return tuple(importlib.import_module(f"platforms.{pdk.replace('-', '_')}.{name}") for name in ("models", "process"))
