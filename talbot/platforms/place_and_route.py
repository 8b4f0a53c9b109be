"""Data of a process and a library of cells for OpenROAD's stages (flow/layout/tcl): one object a library."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib import import_module

from talbot.platforms.layers import GdsLayer
from talbot.platforms.processes import package

PROCESSES = ("sky130",)  # with cells that are drawn for OpenROAD


@dataclass(frozen=True)
class Strap:
    """Power straps on a layer (LEF name). pitch_um: of a pair; 0 for the cells' rails."""

    layer: str
    width_um: float
    pitch_um: float = 0.0
    offset_um: float = 0.0


@dataclass(frozen=True, kw_only=True)
class PlaceAndRoute:
    """A process with a library of cells.

    new_buffers: whether those of synthesis are removed first. site, site_um, row_um: the placement site, its width, the
    cells' height. supply, ground: (net, pins of cells).
    high, low: cell and pin of a constant, 'cell/pin', of which every load gets its own; '' to leave those of synthesis.
    buffer: cell, input, output, between two ports of one net. output_buffer: cell before every output, '' for none.
    diode: cell against antennas. tap: cell, every tap_um; endcap: cell at the rows' ends; '' for none. core_space_um:
    from core to die. clock_root, clock_buffers: cells of the clock tree. straps: connected in their order.
    strap_columns: most columns of vias between two of them, 0 for no limit: cells below cannot be left where these are.
    pins: layers of (horizontal, vertical) pins. clear_um: from a strap's edge to the next pin. signal, clock:
    (lowest, highest) routing layers. kept_free: share of a layer's tracks that global routes leave to the detailed
    router. congestion_iterations: of global routes. layer_rc: resistance (kohm/um) and capacitance (pF/um) of a layer's
    segments, via_rc: kohm of a via, for estimates before extraction. signal_rc, clock_rc: layers whose mean represents
    all before global routing. fill: cells by their full names, since OpenROAD took patterns for regular expressions
    once, for globs later; the largest first. dont_use: patterns of cells. gds: LEF name of a layer or via -> GDS layer.
    outline: GDS layer of the die's. pin_datatype, label_datatype: of GDS. pitch_um: of a layer's tracks, for a LEF that
    is written here. density_addon: share of the way from the least feasible density of placement to 1. padding: sites
    kept free on both sides of a cell in placement. setup_margin_ns, hold_margin_ns: slack that repair leaves at
    estimated parasitics. load_margin: share of a slew's or load's limit that it leaves. fullest: largest share of the
    core that cells may fill after repair.
    """

    new_buffers: bool = True
    site: str
    site_um: float
    row_um: float
    supply: tuple[str, tuple[str, ...]]
    ground: tuple[str, tuple[str, ...]]
    high: str = ""
    low: str = ""
    buffer: tuple[str, str, str]
    output_buffer: str = ""
    diode: str
    tap: str = ""
    tap_um: float = 0.0
    endcap: str = ""
    core_space_um: float = 0.0
    clock_root: str
    clock_buffers: tuple[str, ...]
    straps: tuple[Strap, ...]
    strap_columns: int = 0
    pins: tuple[str, str]
    clear_um: float = 0.0
    signal: tuple[str, str]
    clock: tuple[str, str]
    kept_free: Mapping[str, float]
    congestion_iterations: int = 50
    layer_rc: Mapping[str, tuple[float, float]]
    via_rc: Mapping[str, float]
    signal_rc: tuple[str, ...]
    clock_rc: tuple[str, ...]
    fill: tuple[str, ...]
    dont_use: tuple[str, ...] = ()
    gds: Mapping[str, GdsLayer]
    outline: GdsLayer
    pin_datatype: int
    label_datatype: int
    pitch_um: Mapping[str, float] = field(default_factory=dict)
    density_addon: float = 0.05
    padding: int = 0
    setup_margin_ns: float = field(default=0.4, metadata={"unit": "ns"})
    hold_margin_ns: float = field(default=0.05, metadata={"unit": "ns"})
    load_margin: float = 0.2
    fullest: float = 0.86


def place_and_route(pdk: str) -> PlaceAndRoute:
    """Return the process ``pdk`` with the cells that are drawn here. Raises ParameterError."""
    return import_module(f"talbot.platforms.{package(pdk, PROCESSES, ' for OpenROAD')}.place_and_route").PLATFORM
