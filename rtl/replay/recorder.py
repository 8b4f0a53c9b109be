"""Pytest plugins that run the tests of one level and record a component's ports."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from talbot.rtl.harness.ports import packed, ports_of, split
from talbot.rtl.harness.testbench import Level, hooked
from talbot.rtl.replay.trace import Trace

LEVELS = ("cls", "component", "level")  # names under which a test class holds the component of its level


class Recorder:
    """Traces of the components of the class named ``cls`` that `rtl.harness.testbench.build` builds.

    verilog: those in Verilator, else those in PyMTL. A test with the mark ``sets_registers`` is left out: no ports
    bring the component where it begins.
    """

    def __init__(self, cls: str, verilog: bool = False) -> None:
        self.cls, self.verilog = cls, verilog
        self.parts: list[Trace] = []
        self.test: str | None = ""  # the test that runs; None for one that is left out

    def observe(self, top: Any, dut: Any, verilog: Level) -> Callable[[], None] | None:
        """See rtl.harness.testbench.hooked."""
        if type(dut).__name__ != self.cls or verilog != self.verilog:
            return None
        ports, arguments = ports_of(dut), (*dut._dsl.args, *dut._dsl.kwargs.values())
        part = Trace(self.cls, type(dut).__module__, arguments, ports)
        self.parts.append(part)
        return self._hook(part, top, "s.dut" if hasattr(top, "dut") else "s")

    def _hook(self, part: Trace, top: Any, component: str) -> Callable[[], None]:
        inputs, outputs = (packed(group, component) for group in split(part.ports))
        values = eval(f"lambda s: (({inputs}), ({outputs}))")  # called every cycle: no loop over ports in it
        lines, tests = part.lines, part.tests

        def hook() -> None:
            if self.test is None:
                return
            if not tests or tests[-1][1] != self.test:
                tests.append((len(lines), self.test))
            lines.append("%d %x %x" % (not lines, *values(top)))

        return hook

    def traces(self) -> list[Trace]:
        """Return a Trace per parameter set, its simulators in sequence; the longest first."""
        out: dict[tuple[Any, ...], Trace] = {}
        for part in self.parts:
            whole = out.setdefault(part.arguments, Trace(part.cls, part.module, part.arguments, part.ports))
            whole.tests += [(len(whole.lines) + first, test) for first, test in part.tests]
            whole.lines += part.lines
        return sorted(out.values(), key=lambda trace: -len(trace.lines))


class OneLevel:
    """A pytest plugin that runs the tests of one level only: Verilog in Verilator if ``verilog``, else RTL in PyMTL."""

    def __init__(self, verilog: bool = False) -> None:
        self.verilog = verilog

    def pytest_collection_modifyitems(self, config: pytest.Config, items: list[pytest.Function]) -> None:
        """Deselect the tests of the other levels."""
        kept = [item for item in items if self._at_level(item)]
        config.hook.pytest_deselected(items=[item for item in items if item not in kept])
        items[:] = kept

    def _at_level(self, item: pytest.Function) -> bool:
        """True for a test of the level, or of none."""
        if item.cls is None:
            return True
        parts = [getattr(item.cls, name) for name in LEVELS if hasattr(item.cls, name)]
        if any(getattr(part, "__module__", "").endswith(("_fl", "_cl")) for part in parts):
            return False
        return getattr(item.cls, "verilog", False) is self.verilog


class Plugin(OneLevel):
    """Saves the traces of the class named ``cls`` to ``folder``; level: 'RTL' or 'Verilog'."""

    def __init__(self, cls: str, folder: Path | str, level: str = "RTL") -> None:
        super().__init__(level == "Verilog")
        self.recorder, self.folder = Recorder(cls, self.verilog), Path(folder)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtestloop(self) -> Iterator[None]:
        """Record while tests run."""
        with hooked(observe=self.recorder.observe):
            return (yield)

    def pytest_runtest_setup(self, item: pytest.Item) -> None:
        """Note the test that runs."""
        self.recorder.test = None if item.get_closest_marker("sets_registers") else item.nodeid

    def pytest_sessionfinish(self) -> None:
        """Save the traces."""
        for trace in self.recorder.traces():
            trace.save(self.folder)
