"""design.tcl: all that the stages' Tcl knows of a design and of its process."""

from platforms.openroad import CORNERS

CORE_SPACE_UM = 10.0  # from core to die: pins and their way in


def variables(design, known):
    """Text of design.tcl for a Design and an OpenRoad; files of the PDK under the environment's PDK_ROOT."""
    utilization = round(100 * design.utilization * known.utilization_share, 1)
    plain = {
        "top": design.top,
        "rtl": f"{design.top}.v",
        "constraints": f"{design.top}.sdc",
        "period_ps": round(1000 * design.clock.period_ns),
        "utilization": utilization,
        "aspect": 1.0,
        "core_space": CORE_SPACE_UM,
        "density": round(min(0.95, utilization * 0.015), 3),
        "site": known.site,
        "synthesis_liberty": "synthesis.lib",
        "tap": known.tap,
        "tap_distance": known.tap_um,
        "supply": known.supply[0],
        "ground": known.ground[0],
        "clock_buffer": known.clock_buffer,
        "diode": known.diode,
        "pin_horizontal": known.pins[0],
        "pin_vertical": known.pins[1],
        "signal_layers": "-".join(known.signal),
        "clock_layers": "-".join(known.clock),
        "kept_free": known.kept_free,
        "signal_rc": known.signal_rc,
        "clock_rc": known.clock_rc,
    }
    lists = {
        "supply_pins": known.supply[1],
        "ground_pins": known.ground[1],
        "high": known.high.split("/"),
        "low": known.low.split("/"),
        "fill": known.fill,
        "dont_use": known.dont_use,
        "rcx_rules": known.rcx_rules,
        "straps": [f"{{{s.layer} {s.width_um} {s.pitch_um or 0} {s.offset_um}}}" for s in known.straps],
    }
    files = {
        "tech_lef": known.tech_lef,
        "cell_lef": known.cell_lef,
        **{f"liberty({corner})": known.liberty[corner] for corner in CORNERS},
    }
    return "\n".join(
        [
            f"# {design.name} with {known.library}: written by flow.openroad",
            "set pdk_root $::env(PDK_ROOT)",
            *(f"set {name} {{{value}}}" for name, value in plain.items()),
            *(f"set {name} {{{' '.join(values)}}}" for name, values in lists.items()),
            *(f"set {name} $pdk_root/{path}" for name, path in files.items()),
            "",
        ]
    )
