"""Macros: designs that are laid out before the design that contains them."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from talbot.base.steps import Runner, StepError

from .design import Design, macro_designs
from .netlist.verilog import modules

# Of a macro's run, what the design around it is given as macro.<module>.<part>
PARTS = {"lef": "lef.lef", "gds": "fill.gds", "verilog": "stream_out.verilog", "spice": "stream_out.spice"}
PARTS |= {"netlist": "repair.netlist", "placement": "route.placement"}


def macro_files(design: Design, runners: Mapping[str, Runner], corners: Sequence[str] = ()) -> dict[str, Path]:
    """Files of the macros for the design's Runner, by name. runners: of the macros' runs, by the name of the design.

    corners: of timing.
    """
    parts = PARTS | {corner: f"block_liberty_{corner}.liberty" for corner in corners}
    return {
        f"macro.{macro.top}.{part}": runners[macro.name].paths[source]
        for macro in macro_designs(design)
        for part, source in parts.items()
    }


def check_same(design: Design, rtl: Path, runners: Mapping[str, Runner]) -> None:
    """Raise StepError unless the design's Verilog (file ``rtl``) has the modules that its macros were laid out from."""
    own = modules(rtl.read_text(encoding="utf-8"))
    for macro in macro_designs(design):
        for name, text in modules(runners[macro.name].paths["rtl"].read_text(encoding="utf-8")).items():
            if own.get(name) != text:
                other = f"that of {macro.name}, which is laid out"
                raise StepError(f"{design.name}: its module {name} differs from {other}")
