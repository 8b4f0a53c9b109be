"""The tests themselves on a mutant: it takes the place of the block in the test bench, and they pass or fail."""

import contextlib
import io
import sys

import pytest
from hypothesis import Phase, settings

from rtl import testbench
from rtl.icarus import Driven
from verif.replay import whole_level
from verif.replay.recorder import OneLevel
from verif.results import ROOT

OPTIONS = ("-x", "-p", "no:cacheprovider", "-p", "no:xdist", "--hypothesis-seed=1",
           "-W", "ignore::pytest.PytestAssertRewriteWarning")


class Endless(AssertionError):
    """A simulation that goes on where the block's own has long come to an end."""


class Limited(Driven):
    """A Driven that stops after ``cycles`` clock edges."""

    def __init__(self, command, ports, cycles):
        super().__init__(command, ports)
        self.left = cycles

    def step(self, edge, inputs):
        self.left -= edge
        if self.left < 0:
            raise Endless("no end")
        return super().step(edge, inputs)


class Trial(OneLevel):
    """A pytest plugin: the tests of the recorded level, mutant ``number`` in place of the traced component.

    head: Trace without its lines. program: of the mutants. cycles: that a simulator may run.
    """

    def __init__(self, head, program, number, cycles):
        super().__init__(whole_level(head.cls) == "Verilog")
        self.head, self.command, self.cycles = head, [program.folder / "replay", "--drive", str(number)], cycles
        self.failed, self.took_place = "", False

    def stand_in(self, dut, verilog):
        """See rtl.testbench.stand_ins."""
        arguments = (*dut._dsl.args, *dut._dsl.kwargs.values())
        if (type(dut).__name__, verilog, arguments) != (self.head.cls, self.verilog, self.head.arguments):
            return None
        self.took_place = True
        return Limited(self.command, self.head.ports, self.cycles)

    def pytest_sessionstart(self):
        testbench.stand_ins.append(self.stand_in)

    def pytest_runtest_logreport(self, report):
        if report.failed and not self.failed:
            self.failed = report.nodeid

    def pytest_sessionfinish(self):
        testbench.stand_ins.remove(self.stand_in)


def attempt(head, program, number, tests, cycles):
    """Run ``tests`` (node ids or folders) on mutant ``number``, 0 for none: Trial. Other arguments: see there."""
    trial = Trial(head, program, number, cycles)
    for name in [name for name in sys.modules if name.startswith("rtl.") and ".test." in name + "."]:
        del sys.modules[name]               # tests keep their simulators
    settings.register_profile("trial", phases=(Phase.explicit, Phase.generate), database=None)
    before = settings.get_current_profile_name()
    settings.load_profile("trial")          # a failure is all that is asked for, not the smallest one
    try:
        with contextlib.redirect_stdout(io.StringIO()) as said, contextlib.chdir(ROOT):
            status = pytest.main([*OPTIONS, *map(str, tests)], [trial])
    finally:
        settings.load_profile(before)
    if status not in (pytest.ExitCode.OK, pytest.ExitCode.TESTS_FAILED):
        raise RuntimeError(f"pytest ended with status {status}: {said.getvalue()[-1500:]}")
    return trial
