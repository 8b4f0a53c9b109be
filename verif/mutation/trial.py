"""The tests on a mutant, which replaces the block in the test bench."""

import contextlib
import io
import sys
from collections.abc import Generator, Iterable, Sequence
from pathlib import Path
from typing import Any

import pytest
from hypothesis import Phase, settings

from talbot.base.paths import ROOT
from talbot.rtl.harness.driven import Driven
from talbot.rtl.harness.ports import Port, ports_of
from talbot.rtl.harness.testbench import hooked
from talbot.rtl.harness.translate import translate_component
from talbot.rtl.replay import Trace, whole_level
from talbot.rtl.replay.recorder import OneLevel
from talbot.signoff.netlist.verilog import modules
from talbot.verif.mutation.mutants import Mutant
from talbot.verif.verilated.program import compile_program

OPTIONS = (
    "-x",
    "-p",
    "no:cacheprovider",
    "-p",
    "no:xdist",
    "--hypothesis-seed=1",
    "-W",
    "ignore::pytest.PytestAssertRewriteWarning",
    "--hypothesis-profile=trial",
)


class Endless(AssertionError):
    """The simulation runs much longer than that of the original."""


class Limited(Driven):
    """A Driven that stops after ``cycles`` clock edges."""

    def __init__(self, command: Sequence[str | Path], ports: Sequence[Port], cycles: int) -> None:
        super().__init__(command, ports)
        self.left = cycles

    def step(self, edge: bool, inputs: int) -> bytes:
        """Step the simulation. Raises Endless after the last cycle."""
        self.left -= edge
        if self.left < 0:
            raise Endless("no end")
        return super().step(edge, inputs)


class Trial(OneLevel):
    """A pytest plugin: the tests of the recorded level, with a mutant of the traced component or of a module in it.

    head: Trace without its lines. verilog: with all mutants. mutant: None for the original. cycles: limit of a
    simulator. alone: the tests are the module's own, at RTL.
    """

    def __init__(self, head: Trace, verilog: str, mutant: Mutant | None, cycles: int, alone: bool = False) -> None:
        super().__init__(not alone and whole_level(head.cls) == "Verilog")
        self.head, self.verilog_text, self.mutant, self.cycles = head, verilog, mutant, cycles
        self.failed, self.took_place = "", False

    def substitute(self, dut: Any, verilog: Any, _name: Any) -> Limited | None:
        """Return the mutant that replaces ``dut``, or None (rtl.harness.testbench.hooked)."""
        name, arguments = type(dut).__name__, (*dut._dsl.args, *dut._dsl.kwargs.values())
        if name == self.head.cls:
            if verilog is not self.verilog or arguments != self.head.arguments:
                return None
        elif not self.mutant or name != self.mutant.module or not same_module(self.head, type(dut), arguments):
            return None
        self.took_place = True
        program, ports = compile_program(self.verilog_text, name, ports_of(dut), mutant=True), ports_of(dut)
        number = self.mutant.number if self.mutant else 0
        return Limited([program.folder / "replay", "--drive", str(number)], ports, self.cycles)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtestloop(self) -> Generator[None, Any, Any]:
        """Run the tests with the mutant in place."""
        with hooked(substitute=self.substitute):
            return (yield)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Note the first test that fails."""
        if report.failed and not self.failed:
            self.failed = report.nodeid


def same_module(head: Trace, cls: type, arguments: Sequence[Any]) -> bool:
    """Return whether ``cls(*arguments)`` has the Verilog of the module of that name in the traced component."""
    name = cls.__name__
    alone, within = modules(translate_component(cls(*arguments), name)), modules(head.verilog())
    return name in within and alone.get(name) == within[name]


def attempt(
    head: Trace, verilog: str, mutant: Mutant | None, tests: Iterable[str | Path], cycles: int, alone: bool = False
) -> Trial:
    """Run ``tests`` (node ids, files or folders) on a mutant. Other arguments: see Trial."""
    trial = Trial(head, verilog, mutant, cycles, alone)
    tests_loaded = [name for name in sys.modules if name.startswith("talbot.rtl.") and ".test." in name + "."]
    before_trial = {name: sys.modules.pop(name) for name in tests_loaded}  # tests keep their simulators
    settings.register_profile("trial", phases=(Phase.explicit, Phase.generate), database=None)
    before = settings.get_current_profile_name()  # the option loads its profile after that of conftest.py
    try:
        with contextlib.redirect_stdout(io.StringIO()) as output, contextlib.chdir(ROOT):
            status = pytest.main([*OPTIONS, *map(str, tests)], [trial])
    finally:
        settings.load_profile(before)
        sys.modules.update(before_trial)
    if status not in (pytest.ExitCode.OK, pytest.ExitCode.TESTS_FAILED):
        raise RuntimeError(f"pytest ended with status {status}: {output.getvalue()[-1500:]}")
    return trial
