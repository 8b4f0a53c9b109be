"""What the OpenROAD backend must know of a process with its foundry's standard cells: one object a process.

Paths are those of a PDK as open_pdks installs it (ciel, volare), relative to PDK_ROOT.
"""

import importlib
from dataclasses import dataclass

from models.parameters import ParameterError

PROCESSES = ("sky130",)
CORNERS = ("slow", "typical", "fast")


@dataclass(frozen=True)
class Strap:
    """A layer of power straps, um; pitch_um: of a pair; pitch_um = 0: the cells' rails."""

    layer: str
    width_um: float
    pitch_um: float = 0.0
    offset_um: float = 0.0


@dataclass(frozen=True)
class OpenRoad:
    """name: of the process; library: its cells. orfs_platform, pdk: its names in flow-scripts and in LibreLane.

    liberty: dict of CORNERS -> path. tech_lef, cell_lef, cell_gds, cell_models, rcx_rules: paths; cell_models: tuple of
    Verilog; rcx_rules: tuple, of which the PDK has one. supply, ground: (net, pins of cells). high, low: cell and pin
    of a constant, 'cell/pin'. diode: cell against antennas. tap: cell, every tap_um. straps: tuple of Strap, joined in
    their order. pins: layers of (horizontal, vertical) pins. signal, clock: (lowest, highest) routing layers.
    kept_free: share of their tracks that global routing leaves to the detailed router. signal_rc, clock_rc: layers
    whose wires stand for all before routing. fill: cells by their whole names, since OpenROAD took patterns for regular
    expressions once, for globs later. dont_use: patterns of cells. gds: dict wire or cut -> (layer, datatype).
    outline: (layer, datatype) of the die. pin_datatype, label_datatype: of GDS.
    utilization_share: of what a design asks for, which is meant for cells packed without padding or timing repair.
    """

    name: str
    library: str
    orfs_platform: str
    pdk: str
    liberty: dict
    tech_lef: str
    cell_lef: str
    cell_gds: str
    cell_models: tuple
    rcx_rules: tuple
    site: str
    site_um: float
    row_um: float
    supply: tuple
    ground: tuple
    high: str
    low: str
    diode: str
    tap: str
    tap_um: float
    clock_buffer: str
    straps: tuple
    pins: tuple
    signal: tuple
    clock: tuple
    signal_rc: str
    clock_rc: str
    fill: tuple
    dont_use: tuple
    gds: dict
    outline: tuple
    pin_datatype: int
    label_datatype: int
    utilization_share: float = 0.6
    kept_free: float = 0.5


def process(pdk):
    """The OpenRoad of ``pdk``. Raises ParameterError."""
    if pdk not in PROCESSES:
        raise ParameterError(f"pdk = {pdk!r}: must be one of {', '.join(PROCESSES)} with BACKEND=openroad")
    return importlib.import_module(f"platforms.{pdk.replace('-', '_')}.openroad").PROCESS


def layer_names(pdk):
    """dict (GDS layer, datatype) -> name of the layer in LEF, where it is not that of the wire."""
    known = process(pdk).gds if pdk in PROCESSES else {}
    return {numbers: name for name, numbers in known.items()}
