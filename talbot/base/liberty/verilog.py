"""The cells of a Liberty in Verilog, as simulators take them."""

import re
from pathlib import Path

from talbot.base.tools import plain, run


def write_models(liberty: Path, verilog: Path, options: str = "") -> None:
    """Write what the cells of ``liberty`` do to the file ``verilog``; without delays. options: of Yosys's reader.

    Registers begin with random bits, as on silicon. With X netlists are wrong where the design is right: to a simulator
    x ^ x is x, and a mapper may build a reset so. A register without its reset then shows as a difference, not as X.
    Raises ToolError.
    """
    part = plain(verilog.parent) / verilog.name
    script = f"read_liberty {options} {plain(liberty)}; proc; opt_clean; write_verilog -noattr {part}"
    run(["yosys", "-q", "-p", script])
    verilog.write_text(
        re.sub(r"(?m)^(  reg \w+);$", r"\1 = 1'($random);", verilog.read_text(encoding="utf-8")), encoding="utf-8"
    )
