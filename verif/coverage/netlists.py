"""Netlists of `pytest --netlist` in Verilator: compiled as recorded traces are, driven line by line as in Icarus."""

from rtl.harness.driven import Driven
from rtl.harness.ports import ports_of

from .program import compile_program


def netlist_in_verilator(dut, given, cells):
    """The Netlist ``given`` for the elaborated component ``dut``, running in Verilator. Raises ProgramError."""
    text, ports = "".join(file.read_text() for file in (*cells, given.path)), ports_of(dut)
    program = compile_program(text, given.module or type(dut).__name__, ports)
    return Driven([program.folder / "replay", "--drive", "0"], ports)
