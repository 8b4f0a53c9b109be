"""The file design.tcl: all that the stages' Tcl reads of a design and of its process."""

from talbot.flow.layout.design import Design
from talbot.platforms.openroad import OpenRoadPlatform

CORE_SPACE_UM = 10.0  # from core to die: pins and their way in


def variables(design: Design, tech: OpenRoadPlatform) -> str:
    """Text of design.tcl; files of the PDK are under the environment's PDK_ROOT."""
    plain = (
        {"top": design.top, "rtl": f"{design.top}.sv", "constraints": f"{design.top}.sdc"}
        | {"period_ps": round(1000 * design.clock.period_ns), "utilization": round(100 * tech.utilization, 1)}
        | {"aspect": 1.0, "core_space": CORE_SPACE_UM, "site": tech.site, "synthesis_liberty": "synthesis.lib"}
        | {"tap_distance": tech.tap_um, "supply": tech.supply[0], "ground": tech.ground[0]}
        | {"pin_horizontal": tech.pins[0], "pin_vertical": tech.pins[1]}
        | {"signal_layers": "-".join(tech.signal), "clock_layers": "-".join(tech.clock)}
        | {"setup_margin": tech.setup_margin_ns, "hold_margin": tech.hold_margin_ns}
        | {"load_margin": round(100 * tech.load_margin), "output_buffer": tech.buffer[0]}
        | {name: getattr(tech, name) for name in ("tap", "endcap", "clock_root", "diode", "padding")}
        | {name: getattr(tech, name) for name in ("density_addon", "kept_free")}
    )
    straps = [f"{{{s.layer} {s.width_um} {s.pitch_um or 0} {s.offset_um}}}" for s in tech.straps]
    lists = (
        {"corners": tech.corners, "supply_pins": tech.supply[1], "ground_pins": tech.ground[1], "straps": straps}
        | {name: getattr(tech, name).split("/") for name in ("high", "low")}
        | {name: getattr(tech, name) for name in ("clock_buffers", "signal_rc", "clock_rc", "fill", "dont_use")}
        | {"unconnected": (*tech.fill, tech.tap)}
        | {"layer_rc": [f"{name} {ohm} {farad}" for name, (ohm, farad) in tech.layer_rc.items()]}
        | {"via_rc": [f"{name} {ohm}" for name, ohm in tech.via_rc.items()]}
        | {f"rcx_rules({wires})": paths for wires, paths in tech.rcx_rules.items()}
    )
    files = {name: getattr(tech, name) for name in ("tech_lef", "cell_lef")}
    files |= {f"liberty({corner})": path for corner, path in tech.liberty.items()}
    lines = [
        f"# {design.name} with {tech.library}: written by flow.openroad",
        "set pdk_root $::env(PDK_ROOT)",
        *(f"set {name} {{{value}}}" for name, value in plain.items()),
        *(f"set {name} {{{' '.join(values)}}}" for name, values in lists.items()),
        *(f"set {name} $pdk_root/{path}" for name, path in files.items()),
    ]
    return "\n".join([*lines, ""])
