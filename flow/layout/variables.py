"""The file design.tcl: all that the stages' Tcl (flow/layout/tcl) reads of a design, a process and its cells."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from talbot.models.parameters import check_real
from talbot.platforms.frame import Frame
from talbot.platforms.place_and_route import PlaceAndRoute
from talbot.platforms.twins import TWIN


@dataclass(frozen=True)
class Floor:
    """The outline. utilization: area of the synthesized cells over that of the core. aspect: width by height."""

    utilization: float = 0.5
    aspect: float = field(default=1.0, metadata={"unit": "width / height"})

    def __post_init__(self) -> None:
        check_real("utilization", self.utilization, 0.05, 1.0)
        check_real("aspect", self.aspect, 0.2, 5.0)


def variables(
    top: str, tech: PlaceAndRoute, floor: Floor, files: Mapping[str, object], frame: Frame | None = None
) -> str:
    """Text of design.tcl for the module ``top``. files: variables beyond these; frame: decides instead of ``floor``.

    A value is text, a number, a sequence, or, for an array, a mapping. A sequence's items are words, or lists of words.
    """
    supply, ground = frame.supplies if frame else (tech.supply[0], tech.ground[0])
    values: dict[str, object] = {
        "top": top,
        "constraints": f"{top}.sdc",
        "utilization": round(100 * floor.utilization, 2),
        "aspect": floor.aspect,
        **dict.fromkeys(("die", "core", "ports"), ()),
        "core_space": tech.core_space_um,
        "site": tech.site,
        "site_width": tech.site_um,
        "new_buffers": int(tech.new_buffers),
        "tap": tech.tap,
        "tap_distance": tech.tap_um,
        "endcap": tech.endcap,
        "supply": supply,
        "ground": ground,
        "supply_pins": tech.supply[1],
        "ground_pins": tech.ground[1],
        "straps": [(s.layer, s.width_um, s.pitch_um, s.offset_um) for s in tech.straps],
        "strap_columns": tech.strap_columns,
        "pin_horizontal": tech.pins[0],
        "pin_vertical": tech.pins[1],
        "clear": tech.clear_um,
        "signal_layers": "-".join(tech.signal),
        "clock_layers": "-".join(tech.clock),
        "kept_free": [word for pair in tech.kept_free.items() for word in pair],
        "layer_rc": [word for name, rc in tech.layer_rc.items() for word in (name, *rc)],
        "via_rc": [word for pair in tech.via_rc.items() for word in pair],
        "high": tech.high.split("/") if tech.high else (),
        "low": tech.low.split("/") if tech.low else (),
        "load_margin": round(100 * tech.load_margin),
        "fullest": tech.fullest,
        "setup_margin": tech.setup_margin_ns,
        "twin": TWIN,
        "hold_margin": tech.hold_margin_ns,
        "unconnected": (*tech.fill, *filter(None, [tech.tap])),
    }
    names = "output_buffer", "clock_root", "clock_buffers", "diode", "padding", "density_addon", "signal_rc", "clock_rc"
    values |= {name: getattr(tech, name) for name in (*names, "congestion_iterations", "fill", "dont_use")}
    if frame:
        values |= framed(frame, tech)
    lines = [f"# {top}: written by flow.layout.variables"]
    for name, value in (values | dict(files)).items():
        if isinstance(value, Mapping):
            lines += [f"set {name}({key}) {_word(each)}" for key, each in value.items()]
        else:
            lines.append(f"set {name} {_word(value)}")
    return "\n".join([*lines, ""])


def framed(frame: Frame, tech: PlaceAndRoute) -> dict[str, object]:
    """Variables of a frame: die and core (um), the places of its ports."""
    columns, rows, (left, bottom) = frame.core(tech.site_um, tech.row_um)
    right, top = round(left + columns * tech.site_um, 4), round(bottom + rows * tech.row_um, 4)
    width, length = frame.port_um
    return {
        "die": (0, 0, frame.width_um, frame.height_um),
        "core": (left, bottom, right, top),
        "ports": [word for name, x in frame.ports for word in (name, x, round(frame.height_um - length / 2, 4))],
        "port_layer": frame.layer,
        "port_size": (width, length),
    }


def _word(value: object) -> str:
    """A value in Tcl; text that begins with $ is left to Tcl."""
    if isinstance(value, str):
        return value if value.startswith("$") else f"{{{value}}}"
    if isinstance(value, Sequence):
        return "{" + " ".join(_word(item) if isinstance(item, (tuple, list)) else str(item) for item in value) + "}"
    return str(value)
