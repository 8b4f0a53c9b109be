"""What the OpenROAD backend needs of a process with its foundry's standard cells: one object a process.

Paths are those of a PDK as open_pdks installs it (ciel, volare), relative to PDK_ROOT.
"""

from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path

from .layers import GdsLayer
from .processes import package

PROCESSES = ("sky130",)
WIRES = "nom", "min", "max"  # corners of the wires' parasitics


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

    library: its cells. orfs_platform, pdk: its names in flow-scripts and in LibreLane. liberty, volts: path and
    supply for each corner of the cells, the slowest first. tech_lef, cell_lef, cell_gds, cell_spice, cell_models:
    paths; cell_models: of Verilog. rcx_rules: paths by corner of WIRES, of which the first that the PDK has is read;
    nom is required. supply, ground: (net, pins of cells). high, low: cell and pin of a constant, 'cell/pin'. buffer:
    cell, input, output, between two ports of one net. diode: cell against antennas. tap: cell, every tap_um. endcap:
    cell at the rows' ends. clock_gate: cell, enable, clock, output. clock_root, clock_buffers: of the clock tree.
    straps: connected in their order. pins: layers of (horizontal, vertical) pins. signal, clock: (lowest, highest)
    routing layers. kept_free: share of their tracks that global routing leaves to the detailed router. layer_rc:
    resistance (kohm/um) and capacitance (pF/um)
    of a layer's wires, via_rc: kohm of a via, for estimates before extraction. signal_rc, clock_rc: layers whose mean
    represents all before global routing. fill: cells by their full names, since OpenROAD took patterns for regular
    expressions once, for globs later; the largest first. dont_use: patterns of cells. gds: LEF name of a layer or via
    -> GDS layer. outline: GDS layer of the die's. pin_datatype, label_datatype: of GDS. lvs: KLayout's deck, a
    template. utilization: area of the synthesized cells over that of the core. density_addon: share of the way from
    the least feasible density of placement to 1. padding: sites kept free on both sides of a cell in placement.
    setup_margin_ns, hold_margin_ns: slack that repair leaves at estimated parasitics. load_margin: share of a slew's or
    load's limit that it leaves.
    """

    name: str
    library: str
    orfs_platform: str
    pdk: str
    liberty: dict[str, str]
    volts: dict[str, float]
    tech_lef: str
    cell_lef: str
    cell_gds: str
    cell_spice: str
    cell_models: tuple[str, ...]
    rcx_rules: dict[str, tuple[str, ...]]
    site: str
    site_um: float
    row_um: float
    supply: tuple[str, tuple[str, ...]]
    ground: tuple[str, tuple[str, ...]]
    high: str
    low: str
    buffer: tuple[str, str, str]
    diode: str
    tap: str
    tap_um: float
    endcap: str
    clock_gate: tuple[str, str, str, str]
    clock_root: str
    clock_buffers: tuple[str, ...]
    straps: tuple[Strap, ...]
    pins: tuple[str, str]
    signal: tuple[str, str]
    clock: tuple[str, str]
    layer_rc: dict[str, tuple[float, float]]
    via_rc: dict[str, float]
    signal_rc: tuple[str, ...]
    clock_rc: tuple[str, ...]
    fill: tuple[str, ...]
    dont_use: tuple[str, ...]
    gds: dict[str, GdsLayer]
    outline: GdsLayer
    pin_datatype: int
    label_datatype: int
    deck_layers: tuple[str, ...]
    lvs: Path
    utilization: float = 0.55
    density_addon: float = 0.05
    padding: int = 0
    kept_free: float = 0.3
    setup_margin_ns: float = field(default=0.4, metadata={"unit": "ns"})
    hold_margin_ns: float = field(default=0.05, metadata={"unit": "ns"})
    load_margin: float = 0.2

    @property
    def corners(self) -> tuple[str, ...]:
        """Names of the cells' corners, the slowest first."""
        return tuple(self.liberty)


def openroad_platform(pdk: str) -> OpenRoadPlatform:
    """The process ``pdk`` for OpenROAD. Raises ParameterError."""
    return import_module(f"talbot.platforms.{package(pdk, PROCESSES, ' with BACKEND=openroad')}.openroad").PLATFORM
