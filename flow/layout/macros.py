"""The blocks of a design that are laid out before it, each a design of its own."""

from base.steps import StepError

from .design import macro_designs
from .netlist.verilog import modules

# Of a block's run, what a design that holds it is given as macro.<module>.<part>
PARTS = {
    "lef": "lef.lef",
    "gds": "fill.gds",
    "verilog": "stream_out.verilog",
    "netlist": "place_route.netlist",
    "placement": "reroute.placement",
    "spice": "stream_out.spice",
}


def given(design, runners, corners=()):
    """dict file name -> Path for the design's Runner. runners: dict name of a block's Design -> Runner of its run.
    corners: of timing, where there is one."""
    parts = PARTS | {corner: f"block_liberty_{corner}.liberty" for corner in corners}
    return {
        f"macro.{block.top}.{part}": runners[block.name].paths[source]
        for block in macro_designs(design)
        for part, source in parts.items()
    }


def check_same(design, rtl, runners):
    """Raise StepError unless the design's Verilog (file ``rtl``) holds what its blocks were laid out from."""
    own = modules(rtl.read_text())
    for block in macro_designs(design):
        for name, text in modules(runners[block.name].paths["rtl"].read_text()).items():
            if own.get(name) != text:
                raise StepError(f"{design.name}: its Verilog has another {name} than {block.name}, which is laid out")
