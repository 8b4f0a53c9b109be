"""What the OpenROAD backend needs of a process with its foundry's standard cells: one object a process.

Paths are those of a PDK as open_pdks installs it (ciel, volare), relative to PDK_ROOT.
"""

from dataclasses import dataclass
from importlib import import_module

from .layers import GdsLayer
from .processes import package

PROCESSES = ("sky130",)
CORNERS = ("slow", "typical", "fast")


@dataclass(frozen=True)
class Strap:
    """Power straps on a layer (LEF name). pitch_um: of a pair; 0 for the cells' rails."""

    layer: str
    width_um: float
    pitch_um: float = 0.0
    offset_um: float = 0.0


@dataclass(frozen=True)
class OpenRoadPlatform:
    """A process with its standard cells for OpenROAD.

    library: its cells. orfs_platform, pdk: its names in flow-scripts and in LibreLane. liberty: path for each of
    CORNERS. tech_lef, cell_lef, cell_gds, cell_models, rcx_rules: paths; cell_models: of Verilog; of rcx_rules the PDK
    has one. supply, ground: (net, pins of cells). high, low: cell and pin of a constant, 'cell/pin'. diode: cell
    against antennas. tap: cell, every tap_um. straps: connected in their order. pins: layers of (horizontal, vertical)
    pins. signal, clock: (lowest, highest) routing layers. kept_free: share of their tracks that global routing leaves
    to the detailed router. signal_rc, clock_rc: layers whose resistance and capacitance represent all before routing.
    fill: cells by their full names, since OpenROAD took patterns for regular expressions once, for globs later.
    dont_use: patterns of cells. gds: LEF name of a layer or via -> GDS layer. outline: GDS layer of the die's.
    pin_datatype, label_datatype: of GDS. utilization_share: of a design's utilization, which is meant for cells packed
    without padding or timing repair.
    """

    name: str
    library: str
    orfs_platform: str
    pdk: str
    liberty: dict[str, str]
    tech_lef: str
    cell_lef: str
    cell_gds: str
    cell_models: tuple[str, ...]
    rcx_rules: tuple[str, ...]
    site: str
    site_um: float
    row_um: float
    supply: tuple[str, tuple[str, ...]]
    ground: tuple[str, tuple[str, ...]]
    high: str
    low: str
    diode: str
    tap: str
    tap_um: float
    clock_buffer: str
    straps: tuple[Strap, ...]
    pins: tuple[str, str]
    signal: tuple[str, str]
    clock: tuple[str, str]
    signal_rc: str
    clock_rc: str
    fill: tuple[str, ...]
    dont_use: tuple[str, ...]
    gds: dict[str, GdsLayer]
    outline: GdsLayer
    pin_datatype: int
    label_datatype: int
    utilization_share: float = 0.6
    kept_free: float = 0.5


def openroad_platform(pdk: str) -> OpenRoadPlatform:
    """The process ``pdk`` for OpenROAD. Raises ParameterError."""
    return import_module(f"platforms.{package(pdk, PROCESSES, ' with BACKEND=openroad')}.openroad").PLATFORM
