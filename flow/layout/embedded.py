"""The embedded backend: its steps in order, for a design and a process."""

import sys
from dataclasses import dataclass
from pathlib import Path

from flow.platforms.embedded import process
from flow.simulate.process import ToolError, finish
from models.parameters import check_real

from .steps.drc import Drc
from .steps.equivalence import Equivalence, EquivalenceParameters
from .steps.floorplan import Floorplan, FloorplanParameters
from .steps.library import Library, LibraryParameters
from .steps.lvs import Lvs
from .steps.place_route import PlaceRoute, PlaceRouteParameters
from .steps.stream_out import StreamOut, StreamOutParameters
from .steps.synthesis import Synthesis, SynthesisParameters

ROOT = Path(__file__).parents[2]


@dataclass(frozen=True)
class Options:
    """pdk: process. utilization: cells' area by core area."""

    pdk: str = "sky130"
    utilization: float = 0.5

    def __post_init__(self):
        check_real("utilization", self.utilization, 0.05, 0.95)


def files(design, pdk, folder):
    """What the steps are given: the design's Verilog, made now, and the texts that describe the process."""
    done = finish([sys.executable, "-m", "rtl.export", "--top", design.top, "--out", folder / "rtl"], cwd=ROOT)
    if done.returncode:
        raise ToolError(done.stderr.strip().splitlines()[-1])
    return {"rtl": folder / "rtl" / f"{design.top}.v",
            "platform": ROOT / "flow" / "platforms" / pdk.replace("-", "_") / "embedded.py",
            "coriolis_scripts": ROOT / "flow" / "layout" / "coriolis"}


def embedded(design, options):
    """The steps, in order."""
    known, _ = process(options.pdk)
    clock = design.clock
    return [
        Library(LibraryParameters(options.pdk)),
        Synthesis(SynthesisParameters(design.top, clock.period_ns, 0)),
        Floorplan(FloorplanParameters(options.utilization, row_um=known.row_um, site_um=known.site_um)),
        PlaceRoute(PlaceRouteParameters(options.pdk, clock.port)),
        StreamOut(StreamOutParameters(options.pdk, clock.port)),
        Equivalence(EquivalenceParameters(design.top, clock.port)),
        Drc(),
        Lvs(),
    ]
