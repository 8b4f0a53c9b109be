"""Netlists of `pytest --netlist` in Verilator: compiled as recorded traces are, driven line by line as in Icarus."""

from pathlib import Path

from rtl import icarus_level
from rtl.ports import ports_of

from .program import compile_program


def in_verilator(dut, name):
    """Command of the simulation of the netlist given for ``name``, in Icarus where none was. Raises ProgramError."""
    if name not in icarus_level.netlists:
        return icarus_level.in_icarus(dut, name)
    icarus_level.asked.add(name)
    path, module = icarus_level.netlists[name]
    text = "".join(Path(file).read_text() for file in (*icarus_level.cells, path))
    return [compile_program(text, module or type(dut).__name__, ports_of(dut)).folder / "replay", "--drive", "0"]
