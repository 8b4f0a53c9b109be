"""The file design.tcl: all that the stages' Tcl reads of a design and of its process."""

from flow.layout.design import Design
from platforms.openroad import CORNERS, OpenRoadPlatform

CORE_SPACE_UM = 10.0  # from core to die: pins and their way in


def variables(design: Design, tech: OpenRoadPlatform) -> str:
    """Text of design.tcl; files of the PDK are under the environment's PDK_ROOT."""
    utilization = round(100 * design.utilization * tech.utilization_share, 1)
    density = round(min(0.95, utilization * 0.015), 3)
    period_ps = round(1000 * design.clock.period_ns)
    plain = (
        {"top": design.top, "rtl": f"{design.top}.v", "constraints": f"{design.top}.sdc", "period_ps": period_ps}
        | {"utilization": utilization, "aspect": 1.0, "core_space": CORE_SPACE_UM, "density": density}
        | {"site": tech.site, "synthesis_liberty": "synthesis.lib", "tap": tech.tap, "tap_distance": tech.tap_um}
        | {"supply": tech.supply[0], "ground": tech.ground[0], "clock_buffer": tech.clock_buffer, "diode": tech.diode}
        | {"pin_horizontal": tech.pins[0], "pin_vertical": tech.pins[1]}
        | {"signal_layers": "-".join(tech.signal), "clock_layers": "-".join(tech.clock)}
        | {name: getattr(tech, name) for name in ("kept_free", "signal_rc", "clock_rc")}
    )
    straps = [f"{{{s.layer} {s.width_um} {s.pitch_um or 0} {s.offset_um}}}" for s in tech.straps]
    lists = (
        {"supply_pins": tech.supply[1], "ground_pins": tech.ground[1]}
        | {name: getattr(tech, name).split("/") for name in ("high", "low")}
        | {name: getattr(tech, name) for name in ("fill", "dont_use", "rcx_rules")}
        | {"straps": straps}
    )
    files = {name: getattr(tech, name) for name in ("tech_lef", "cell_lef")}
    files |= {f"liberty({corner})": tech.liberty[corner] for corner in CORNERS}
    lines = [
        f"# {design.name} with {tech.library}: written by flow.openroad",
        "set pdk_root $::env(PDK_ROOT)",
        *(f"set {name} {{{value}}}" for name, value in plain.items()),
        *(f"set {name} {{{' '.join(values)}}}" for name, values in lists.items()),
        *(f"set {name} $pdk_root/{path}" for name, path in files.items()),
    ]
    return "\n".join([*lines, ""])
