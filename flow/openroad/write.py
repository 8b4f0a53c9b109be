"""The files of a design's run: Verilog, SDC, Tcl, and projects for flow-scripts and LibreLane."""

from pathlib import Path

from talbot.base.files import staged
from talbot.flow.layout.design import DESIGNS, Design
from talbot.flow.layout.steps.stage import SCRIPTS
from talbot.flow.layout.timing.constraints import sdc
from talbot.flow.layout.variables import Floor, variables
from talbot.flow.openroad.librelane import librelane
from talbot.flow.openroad.orfs import orfs
from talbot.flow.openroad.stages import stages
from talbot.flow.openroad.tinytapeout import PROJECTS, project_files
from talbot.platforms.openroad import OpenRoadPlatform
from talbot.platforms.sky130.tinytapeout import FRAME
from talbot.rtl.verilog import export_verilog
from talbot.signoff.netlist.gating import ClockGate


def rtl(design: Design, folder: Path) -> str:
    """Return the Verilog of a Design, exported now: text. Raises ToolError."""
    (path,) = export_verilog(folder, [design.top], design.options)
    return path.read_text(encoding="utf-8")


def design_tcl(design: Design, tech: OpenRoadPlatform) -> str:
    """Text of design.tcl; files of the PDK are under the environment's PDK_ROOT."""
    files: dict[str, object] = {
        "pdk_root": "$::env(PDK_ROOT)",
        "rtl": f"{design.top}.sv",
        "synthesis_liberty": "synthesis.lib",
        "period_ps": round(1000 * design.clock.period_ns),
        "corners": tech.corners,
        "closed": (),
        "clock": "",
        "tech_lef": f"$pdk_root/{tech.tech_lef}",
        "cell_lef": f"$pdk_root/{tech.cell_lef}",
        "liberty": {corner: f"$pdk_root/{path}" for corner, path in tech.liberty.items()},
        "rcx_rules": tech.rcx_rules,
    }
    return variables(design.top, tech, Floor(tech.utilization), files)


def write(design: Design, tech: OpenRoadPlatform, folder: Path) -> list[str]:
    """Write the files of ``design`` for the process ``tech`` into ``folder``; returns their names."""
    folder = Path(folder)
    verilog = rtl(design, folder)
    files = {
        f"{design.top}.sdc": sdc(design, propagated=False),
        "design.tcl": design_tcl(design, tech),
        **orfs(design, tech, verilog),
        **librelane(design, tech, verilog),
    }
    if (project := f"{FRAME}{design.name}") in PROJECTS:
        files |= project_files(DESIGNS[project], rtl(DESIGNS[project], folder / "tinytapeout" / "src"))
    files |= {str(path): text for path, text in ClockGate(*tech.clock_gate).files().items()}
    names = dict.fromkeys(f"{name}.tcl" for name in ("common", *(stage.name for stage in stages(tech))))
    files |= {name: (SCRIPTS / name).read_text(encoding="utf-8") for name in names}
    for name, text in files.items():
        with staged((folder / name).parent) as part:
            (part / Path(name).name).write_text(text, encoding="utf-8")
    return [f"{design.top}.sv", *sorted(files)]
