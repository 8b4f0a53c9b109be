"""The tests themselves on a mutant: it takes the place of the block in the test bench, and they pass or fail."""

import contextlib
import io
import re
import sys

import pytest
from hypothesis import Phase, settings

from rtl.harness.driven import Driven
from rtl.harness.ports import ports_of
from rtl.harness.testbench import hooked
from rtl.harness.translate import translate_component
from rtl.replay import whole_level
from rtl.replay.recorder import OneLevel
from verif.coverage.program import compile_program
from verif.results import ROOT

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
    """A pytest plugin: the tests of the recorded level, a mutant in place of the traced component, or of the module in
    it that is mutated.

    head: Trace without its lines. verilog: text with all mutants. mutant: Mutant, or None for the original. cycles:
    that a simulator may run. alone: the tests are the module's own, at RTL.
    """

    def __init__(self, head, verilog, mutant, cycles, alone=False):
        super().__init__(not alone and whole_level(head.cls) == "Verilog")
        self.head, self.verilog_text, self.mutant, self.cycles = head, verilog, mutant, cycles
        self.failed, self.took_place = "", False

    def substitute(self, dut, verilog, _name):
        """See rtl.harness.testbench.hooked."""
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
    def pytest_runtestloop(self):
        with hooked(substitute=self.substitute):
            return (yield)

    def pytest_runtest_logreport(self, report):
        if report.failed and not self.failed:
            self.failed = report.nodeid


def same_module(head, cls, arguments):
    """True if a component of its own is the module of that name in the traced one, parameters and all."""
    name = cls.__name__
    alone, within = (
        re.search(rf"(?s)^module {name}\b.*?^endmodule", re.sub(r"(?m)^\s*//.*\n", "", text), re.MULTILINE)
        for text in (translate_component(cls(*arguments), name), head.verilog())
    )
    return bool(within) and alone[0] == within[0]


def attempt(head, verilog, mutant, tests, cycles, alone=False):
    """Run ``tests`` (node ids, files or folders) on a mutant: Trial. Arguments: see there."""
    trial = Trial(head, verilog, mutant, cycles, alone)
    tests_loaded = [name for name in sys.modules if name.startswith("rtl.") and ".test." in name + "."]
    before_trial = {name: sys.modules.pop(name) for name in tests_loaded}  # tests keep their simulators
    settings.register_profile("trial", phases=(Phase.explicit, Phase.generate), database=None)
    before = settings.get_current_profile_name()  # the option loads it behind conftest.py, which has its own
    try:
        with contextlib.redirect_stdout(io.StringIO()) as said, contextlib.chdir(ROOT):
            status = pytest.main([*OPTIONS, *map(str, tests)], [trial])
    finally:
        settings.load_profile(before)
        sys.modules.update(before_trial)
    if status not in (pytest.ExitCode.OK, pytest.ExitCode.TESTS_FAILED):
        raise RuntimeError(f"pytest ended with status {status}: {said.getvalue()[-1500:]}")
    return trial
