"""The netlists of `pytest --netlist` in Verilator, driven line by line as in Icarus."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from talbot.rtl.harness.driven import Driven
from talbot.rtl.harness.netlists import Netlist
from talbot.rtl.harness.ports import ports_of
from talbot.verif.verilated.program import compile_program


def netlist_in_verilator(dut: Any, netlist: Netlist, cells: Iterable[Path]) -> Driven:
    """Run the Netlist ``netlist`` for the elaborated component ``dut`` in Verilator. Raises ToolError."""
    text, ports = "".join(file.read_text(encoding="utf-8") for file in (*cells, netlist.path)), ports_of(dut)
    program = compile_program(text, netlist.module or type(dut).__name__, ports)
    return Driven([program.folder / "replay", "--drive", "0"], ports)
