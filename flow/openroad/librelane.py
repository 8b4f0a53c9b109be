"""A design for LibreLane: config.yaml, constraints, Verilog. Run: librelane config.yaml."""

from talbot.flow.layout.design import Design
from talbot.flow.layout.timing.constraints import sdc
from talbot.platforms.openroad import OpenRoadPlatform

# LibreLane reads the constraints in every step and sets this variable in those before the clock has its tree
PROPAGATE = """if {[info exists ::env(OPENLANE_SDC_IDEAL_CLOCKS)] && $::env(OPENLANE_SDC_IDEAL_CLOCKS)} {
  unset_propagated_clock [all_clocks]
} else {
  set_propagated_clock [all_clocks]
}
"""


def librelane(design: Design, tech: OpenRoadPlatform, verilog: str) -> dict[str, str]:
    """Files of the design: text by path."""
    utilization = round(100 * tech.utilization)
    values = (
        {"DESIGN_NAME": design.top, "VERILOG_FILES": f"[dir::{design.top}.sv]"}
        | {"CLOCK_PORT": design.clock.port, "CLOCK_PERIOD": design.clock.period_ns}
        | {"PNR_SDC_FILE": "dir::pnr.sdc", "SIGNOFF_SDC_FILE": "dir::signoff.sdc"}
        | {"FP_SIZING": "relative", "FP_CORE_UTIL": utilization, "FP_ASPECT_RATIO": 1}
        | {"PL_TARGET_DENSITY_PCT": min(95, utilization + 15)}
    )
    config = "meta:\n  version: 2\n  flow: Classic\n" + "".join(f"{key}: {value}\n" for key, value in values.items())
    constraints = {"pnr.sdc": sdc(design, propagated=False) + PROPAGATE, "signoff.sdc": sdc(design)}
    files = {"config.yaml": config, **constraints, f"{design.top}.sv": verilog}
    return {f"librelane/{name}": text for name, text in files.items()}
