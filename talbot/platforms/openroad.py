"""Process data of the OpenROAD backend with the foundry's standard cells: one object a process.

Paths are those of a PDK as open_pdks installs it (ciel, volare), relative to PDK_ROOT.
"""

from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

from talbot.platforms.place_and_route import PlaceAndRoute
from talbot.platforms.processes import package

PROCESSES = ("sky130",)
WIRES = "nom", "min", "max"  # corners of the wires' parasitics


@dataclass(frozen=True, kw_only=True)
class OpenRoadPlatform(PlaceAndRoute):
    """A process with its foundry's standard cells for OpenROAD.

    library: its cells. orfs_platform, pdk: its names in flow-scripts and in LibreLane. liberty, volts: path and
    supply for each corner of the cells, the slowest first. tech_lef, cell_lef, cell_gds, cell_spice, cell_models:
    paths; cell_models: of Verilog. rcx_rules: paths by corner of WIRES, of which the first that the PDK has is read;
    nom is required. clock_gate: cell, enable, clock, output. deck_layers: of PDKMaster's deck. lvs: KLayout's deck, a
    template. utilization: area of the synthesized cells over that of the core.
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
    clock_gate: tuple[str, str, str, str]
    deck_layers: tuple[str, ...]
    lvs: Path
    utilization: float = 0.55

    @property
    def corners(self) -> tuple[str, ...]:
        """Names of the cells' corners, the slowest first."""
        return tuple(self.liberty)


def openroad_platform(pdk: str) -> OpenRoadPlatform:
    """Return the process ``pdk`` for OpenROAD. Raises ParameterError."""
    folder = package(pdk, PROCESSES, " with a foundry's cells")
    return import_module(f"talbot.platforms.{folder}.openroad").PLATFORM
