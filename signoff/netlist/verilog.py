"""Text of Verilog modules, for comparison."""

import re


def modules(verilog: str) -> dict[str, str]:
    """Map each module's name to its text without comments and names of processes, which depend on the place."""
    text = re.sub(r"(?m)^\s*//.*\n|(?<=begin : )_lambda__\w+", "", verilog)
    return {match[1]: match[0] for match in re.finditer(r"(?ms)^module (\w+)\b.*?^endmodule", text)}
