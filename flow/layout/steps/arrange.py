"""The cells placed again, for short wires: Coloquinte."""

import json
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from talbot.base.steps import Files, Step
from talbot.models.parameters import check_int, check_real
from talbot.platforms.coriolis import coriolis_platform

from ..netlist.netlist import Netlist
from ..repair.repair import planned


@dataclass(frozen=True)
class ArrangeParameters:
    """Parameters of `Arrange`.

    pdk: process. effort: of the placer, 1..9. spread: of what is empty, the share between cells: what is packed does
    not route, what is spread has long wires.
    """

    pdk: str = "sky130"
    effort: int = 3
    spread: float = 1.0

    def __post_init__(self) -> None:
        check_int("effort", self.effort, 1, 9)
        check_real("spread", self.spread, 0, 1)


class Arrange(Step[ArrangeParameters]):
    """All cells but macros and the clock tree's are placed again.

    stopped: why the placer gave up. before_um, wire_um: estimated length of all nets.
    """

    name = "arrange"
    inputs = {
        "netlist": "place.netlist",
        "placement": "place.placement",
        "floorplan": "floorplan.floorplan",
        "areas": "library.areas",
        "synthesized": "synthesis.netlist",
    }
    outputs = {"netlist": "netlist.json", "placement": "placement.json", "log": "coloquinte.log"}
    metrics = {"stopped": "", "before_um": "um", "wire_um": "um"}
    tools = ("python coloquinte",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        from ..repair.arrange import arranged

        p, tech = self.parameters, coriolis_platform(self.parameters.pdk)
        netlist = Netlist.read(inputs["netlist"])
        placement, floorplan, areas = (
            json.loads(inputs[name].read_text(encoding="utf-8")) for name in ("placement", "floorplan", "areas")
        )
        plan = planned(netlist, placement, floorplan, areas, tech)
        before = sum(plan.lengths().values())
        own = {instance.name for instance in Netlist.read(inputs["synthesized"]).instances}
        try:
            with printed_to(outputs["log"]):
                arranged(plan, plan.instances.keys() - own, p.effort, p.spread)
        except RuntimeError as error:  # the rows are too full
            for name in ("netlist", "placement"):
                outputs[name].write_text("", encoding="utf-8")
            return dict.fromkeys(self.metrics) | {"stopped": str(error)}
        made, placement["instances"] = plan.listed(netlist, placement["instances"], tech.fill_cells)
        made.write(outputs["netlist"])
        outputs["placement"].write_text(json.dumps(placement, indent=0) + "\n", encoding="utf-8")
        return {"stopped": None, "before_um": round(before, 1), "wire_um": round(sum(plan.lengths().values()), 1)}


@contextmanager
def printed_to(path: Path) -> Iterator[None]:
    """Let what compiled code prints go into a file."""
    sys.stdout.flush()
    kept = os.dup(1)
    try:
        with path.open("w", encoding="utf-8") as file:
            os.dup2(file.fileno(), 1)
            yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
