"""A design for OpenROAD-flow-scripts: config.mk, constraint.sdc, rules-base.json, in a separate folder of designs."""

import json

from talbot.flow.layout.design import Design
from talbot.flow.layout.timing.constraints import sdc
from talbot.platforms.openroad import OpenRoadPlatform

# Metrics of flow-scripts' own rules-base.json that a signed-off design must keep, whatever its size
RULES = {
    "constraints__clocks__count": (1, "=="),
    "detailedplace__design__violations": (0, "=="),
    "detailedroute__route__drc_errors": (0, "<="),
    "detailedroute__antenna__violating__nets": (0, "<="),
    "finish__timing__setup__ws": (0.0, ">="),
    "finish__timing__drv__setup_violation_count": (0, "<="),
    "finish__timing__drv__hold_violation_count": (0, "<="),
}


def orfs(design: Design, tech: OpenRoadPlatform, verilog: str) -> dict[str, str]:
    """Files of the design: text by path. Run: make DESIGN_HOME=<folder>/orfs DESIGN_CONFIG=.../config.mk."""
    name, platform = design.name, tech.orfs_platform
    utilization = round(100 * tech.utilization)
    period_ps = round(1000 * design.clock.period_ns)  # the default is the number in the SDC, which is in ns
    values = (
        {"DESIGN_NAME": design.top, "DESIGN_NICKNAME": name, "PLATFORM": platform}
        | {"VERILOG_FILES": f"$(DESIGN_HOME)/src/{name}/{design.top}.sv"}
        | {"SDC_FILE": f"$(DESIGN_HOME)/{platform}/{name}/constraint.sdc"}
        | {"CORE_UTILIZATION": utilization, "CORE_ASPECT_RATIO": 1, "CORE_MARGIN": 10}
        | {"PLACE_DENSITY_LB_ADDON": 0.1, "ABC_CLOCK_PERIOD_IN_PS": period_ps}
    )
    config = "".join(f"export {key} = {value}\n" for key, value in values.items())
    rules = {key: {"value": value, "compare": compare} for key, (value, compare) in RULES.items()}
    files = {"config.mk": config, "constraint.sdc": sdc(design, propagated=False)}
    files["rules-base.json"] = json.dumps(rules, indent=4) + "\n"
    ours = {f"orfs/{platform}/{name}/{file}": text for file, text in files.items()}
    return ours | {f"orfs/src/{name}/{design.top}.sv": verilog}
