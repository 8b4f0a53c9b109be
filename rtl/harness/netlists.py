"""Netlists that replace the translated Verilog at the Icarus level of the tests (`pytest --netlist`)."""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pymtl3 import Component

from talbot.models.parameters import ParameterError
from talbot.rtl.harness.driven import Driven
from talbot.rtl.harness.icarus import IcarusError, in_icarus
from talbot.rtl.harness.ports import ports_of


@dataclass(frozen=True)
class Netlist:
    """A Verilog file whose ``module`` replaces what the tests build as ``name``; None: the class's name."""

    name: str
    path: Path
    module: str | None = None


def netlist(option: str) -> Netlist:
    """Return the Netlist of NAME=FILE or NAME=FILE:MODULE. Raises ParameterError."""
    match = re.fullmatch(r"(\w+)=([^:]+)(?::(\w+))?", option)
    if not match:
        raise ParameterError(f"--netlist = {option!r}: must be NAME=FILE or NAME=FILE:MODULE")
    return Netlist(match[1], Path(match[2]), match[3])


def netlist_in_icarus(dut: Component, replacement: Netlist, cells: Sequence[Path]) -> Driven:
    """Start the netlist ``replacement`` of the elaborated component ``dut`` in Icarus. Raises IcarusError."""
    return in_icarus(
        replacement.name, replacement.module or type(dut).__name__, ports_of(dut), [replacement.path, *cells]
    )


@dataclass(frozen=True)
class Netlists:
    """Netlists by the name that tests give `build`, with the models of their ``cells``; built: names that tests built.

    simulate: gives the running simulation of a Netlist.
    """

    netlists: Mapping[str, Netlist]
    cells: Sequence[Path] = ()
    simulate: Callable[[Component, Netlist, Sequence[Path]], Driven] = netlist_in_icarus
    built: set[str] = field(default_factory=set)

    def substitute(self, dut: Any, verilog: bool | str, name: str) -> Driven | None:
        """See rtl.harness.testbench.hooked."""
        if verilog != "icarus":
            return None
        self.built.add(name)
        if not (replacement := self.netlists.get(name)):
            return None
        if not replacement.path.is_file():
            raise IcarusError(f"netlist = {replacement.path}: no such file")
        return self.simulate(dut, replacement, self.cells)

    def files(self, name: str) -> list[Path]:
        """Return the netlist that replaces ``name``, for a separate bench, and the cells; [] without one."""
        self.built.add(name)
        return [self.netlists[name].path, *self.cells] if name in self.netlists else []

    def unused(self) -> list[str]:
        """Return the names of the netlists that no test built."""
        return sorted(set(self.netlists) - self.built)
