"""design.tcl: all that the stages' Tcl knows of a design and of its process."""

from flow.layout.design import Design
from platforms.openroad import CORNERS, OpenRoadPlatform

CORE_SPACE_UM = 10.0  # from core to die: pins and their way in


def variables(design: Design, tech: OpenRoadPlatform) -> str:
    """Text of design.tcl for a Design and an OpenRoad; files of the PDK under the environment's PDK_ROOT."""
    utilization = round(100 * design.utilization * tech.utilization_share, 1)
    plain = {
        "top": design.top,
        "rtl": f"{design.top}.v",
        "constraints": f"{design.top}.sdc",
        "period_ps": round(1000 * design.clock.period_ns),
        "utilization": utilization,
        "aspect": 1.0,
        "core_space": CORE_SPACE_UM,
        "density": round(min(0.95, utilization * 0.015), 3),
        "site": tech.site,
        "synthesis_liberty": "synthesis.lib",
        "tap": tech.tap,
        "tap_distance": tech.tap_um,
        "supply": tech.supply[0],
        "ground": tech.ground[0],
        "clock_buffer": tech.clock_buffer,
        "diode": tech.diode,
        "pin_horizontal": tech.pins[0],
        "pin_vertical": tech.pins[1],
        "signal_layers": "-".join(tech.signal),
        "clock_layers": "-".join(tech.clock),
        "kept_free": tech.kept_free,
        "signal_rc": tech.signal_rc,
        "clock_rc": tech.clock_rc,
    }
    lists = {
        "supply_pins": tech.supply[1],
        "ground_pins": tech.ground[1],
        "high": tech.high.split("/"),
        "low": tech.low.split("/"),
        "fill": tech.fill,
        "dont_use": tech.dont_use,
        "rcx_rules": tech.rcx_rules,
        "straps": [f"{{{s.layer} {s.width_um} {s.pitch_um or 0} {s.offset_um}}}" for s in tech.straps],
    }
    files = {
        "tech_lef": tech.tech_lef,
        "cell_lef": tech.cell_lef,
        **{f"liberty({corner})": tech.liberty[corner] for corner in CORNERS},
    }
    return "\n".join(
        [
            f"# {design.name} with {tech.library}: written by flow.openroad",
            "set pdk_root $::env(PDK_ROOT)",
            *(f"set {name} {{{value}}}" for name, value in plain.items()),
            *(f"set {name} {{{' '.join(values)}}}" for name, values in lists.items()),
            *(f"set {name} $pdk_root/{path}" for name, path in files.items()),
            "",
        ]
    )
