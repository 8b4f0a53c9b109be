"""Checks of the stages' results, by the sign-off steps of flow.layout."""

import json
import re
from collections.abc import Callable
from pathlib import Path

from talbot.base.liberty.functional import with_latches
from talbot.base.liberty.read import only, read
from talbot.base.liberty.verilog import write_models
from talbot.base.liberty.write import text
from talbot.base.steps import Runner, Step
from talbot.flow.layout.chain import netlist_tests, timing_steps
from talbot.flow.layout.design import Design
from talbot.flow.layout.options import Options
from talbot.flow.layout.steps.antenna import Antenna
from talbot.flow.layout.steps.equivalence import Equivalence, EquivalenceParameters
from talbot.flow.layout.steps.fill import Fill
from talbot.flow.layout.steps.ir_drop import IrDrop as MeshDrop
from talbot.flow.layout.steps.library import Library
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.flow.layout.steps.power import Power
from talbot.flow.layout.steps.sta import Sta
from talbot.flow.layout.timing.constraints import sdc
from talbot.flow.openroad.drc import Drc
from talbot.flow.openroad.ir_drop import IrDrop, IrDropParameters
from talbot.flow.openroad.lvs import Lvs
from talbot.flow.openroad.netlists import routed_netlist
from talbot.platforms.openroad import WIRES, OpenRoadPlatform
from talbot.platforms.wires import CORNERS

ELSEWHERE = Sta, MeshDrop  # OpenROAD itself times all corners and solves the power grid


def checks(design: Design, tech: OpenRoadPlatform) -> list[Step]:
    """Return the steps, in order."""
    timing = timing_steps(design, Options(pdk=tech.name, utilization=tech.utilization))
    powered = [step.parameters.corner for step in timing if isinstance(step, Power)]
    nets = tech.supply[0], tech.ground[0]
    return [
        *(step(PdkParameters(tech.name)) for step in (Fill, Drc, Antenna)),
        Equivalence(EquivalenceParameters(design.top, design.clock.port)),
        *netlist_tests(design),
        Lvs(PdkParameters(tech.name)),
        *(step for step in timing if not isinstance(step, ELSEWHERE)),
        *(IrDrop(IrDropParameters(corner, tech.volts[corner], *nets)) for corner in powered),
    ]


def given(
    design: Design, tech: OpenRoadPlatform, root: Path, folder: Path, size_um: tuple[float, float]
) -> dict[str, Path]:
    """The steps' inputs by name, of the run in ``folder`` with the PDK in ``root``; files are written next to it."""
    made = folder / "signoff"
    made.mkdir(exist_ok=True)
    netlist = routed_netlist(folder / "final.v", design.top)
    netlist.write(made / "netlist.json")
    (made / "final.sdc").write_text(sdc(design), encoding="utf-8")
    (made / "floorplan.json").write_text(
        json.dumps({"width_um": size_um[0], "height_um": size_um[1]}), encoding="utf-8"
    )
    both = (folder / name for name in ("netlist.v", "final.v"))  # repair may leave no instance of a cell
    used = {cell for path in both for cell in re.findall(rf"{tech.library}__\w+", path.read_text(encoding="utf-8"))}
    for corner in tech.corners:
        (made / f"{corner}.lib").write_text(
            only((root / tech.liberty[corner]).read_text(encoding="utf-8"), used), encoding="utf-8"
        )
    (made / "functional.lib").write_text(text(with_latches(read(made / f"{tech.corners[0]}.lib"))), encoding="utf-8")
    write_models(made / "functional.lib", made / "cells.v", "-ignore_miss_func")
    return {
        "rtl": folder / f"{design.top}.sv",
        "sdc": made / "final.sdc",
        "stream_out.netlist": made / "netlist.json",
        "stream_out.plan": made / "floorplan.json",
        "synthesis.verilog": folder / "netlist.v",
        "stream_out.verilog": folder / "final.v",
        "stream_out.gds": folder / "final.gds",
        "database": folder / "mend.odb",
        "powered": folder / "final.power.v",
        "cells.spice": root / tech.cell_spice,
        **{f"extraction.{own}": folder / f"{wires}.spef" for own, wires in zip(CORNERS, WIRES, strict=True)},
        **{f"timing.{corner}": made / f"{corner}.lib" for corner in tech.corners},
        **{f"sta_{corner}.sdf": folder / f"{WIRES[0]}.{corner}.sdf" for corner in tech.corners},
    }


def check(
    design: Design,
    tech: OpenRoadPlatform,
    root: Path,
    folder: Path,
    size_um: tuple[float, float],
    note: Callable[[str], object],
) -> Runner:
    """Run all checks of the run in ``folder``; their Runner. size_um: of the die. Raises ToolError, StepError."""
    runner = Runner(folder / "steps", given(design, tech, root, folder, size_um), note, folder.parent / "shared")
    runner.run(Library(PdkParameters(tech.name)))
    runner.paths |= {
        "library.liberty": folder / "signoff" / "functional.lib",
        "library.verilog": folder / "signoff" / "cells.v",
    }
    runner.run_all(checks(design, tech))
    return runner
