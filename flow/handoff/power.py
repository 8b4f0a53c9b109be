"""A flat netlist with its supplies drawn in: ports of the module and pins of every cell."""

import re
from collections.abc import Mapping

from talbot.models.parameters import ParameterError

HEADER = re.compile(r"(?m)^(module\s+\S+\s*)\((.*?)\);")
INSTANCE = re.compile(r"(?m)^(\s+\w+\s+(?:\\\S+\s+|\w+\s*)\()(\..*)\);$")


def powered(verilog: str, supplies: Mapping[str, str]) -> str:
    """``verilog`` with supplies as ports of the module, by the pin that each has on every cell.

    verilog: one module, an instance a line, as flow.layout writes it. Raises ParameterError for any other.
    """
    if len(HEADER.findall(verilog)) != 1:
        raise ParameterError("netlist = not one module: must be the flat netlist of a layout")
    declared = "".join(f"\n  inout {net};" for net in supplies.values())
    pins = "".join(f", .{pin}({net})" for pin, net in supplies.items())
    text = HEADER.sub(lambda m: f"{m[1]}({', '.join([m[2], *supplies.values()])});{declared}", verilog)
    return INSTANCE.sub(lambda m: f"{m[1]}{m[2]}{pins});", text)
