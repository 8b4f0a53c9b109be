"""Tests that are slow run with --all. The Icarus level of the blocks' tests runs on netlists on demand; where Icarus

is missing it is skipped with the reason. A property fails with the first input that breaks it, at once;
--hypothesis-profile=smallest looks for the smallest one, which takes minutes where a simulator has to run.
"""

import importlib.util
import re

import pytest
from hypothesis import Phase, settings

settings.register_profile("first", phases=[Phase.explicit, Phase.reuse, Phase.generate])
settings.register_profile("smallest", phases=list(Phase))
settings.load_profile("first")

# These draw and read layouts: KLayout's Python module comes with the environment of cells and layouts
LAYOUTS = "cells/extract", "cells/compact", "cells/lef", "cells/test"
collect_ignore = [] if importlib.util.find_spec("klayout") else list(LAYOUTS)


def pytest_report_header():
    if collect_ignore:
        return f"left out: {', '.join(LAYOUTS)}: klayout is not installed (make setup-layout)"


def pytest_addoption(parser):
    parser.addoption("--all", action="store_true", help="run the tests marked slow, too (make verify)")
    group = parser.getgroup("netlists", "run the Icarus level of the tests on netlists")
    group.addoption(
        "--netlist",
        action="append",
        default=[],
        metavar="NAME=FILE[:MODULE]",
        help="this Verilog in place of what the tests build as NAME (rtl/<block>/test): AmpCtrl=gates.v",
    )
    group.addoption(
        "--netlist-in",
        choices=("icarus", "verilator"),
        default="icarus",
        help="simulator of the netlists; Verilator knows no X (%(default)s)",
    )
    group.addoption("--cells", action="append", default=[], metavar="FILE", help="models of the netlists' cells")


def pytest_configure(config):
    config.addinivalue_line("markers", "slow: runs with --all only")
    for option in config.getoption("netlist"):
        match = re.fullmatch(r"(\w+)=([^:]+)(?::(\w+))?", option)
        if not match:
            raise pytest.UsageError(f"--netlist = {option!r}: must be NAME=FILE or NAME=FILE:MODULE")
        from rtl import icarus_level

        icarus_level.netlists[match[1]] = match[2], match[3]
        icarus_level.cells[:] = config.getoption("cells")
    if config.getoption("netlist") and config.getoption("netlist_in") == "verilator":
        from rtl import icarus_level
        from verif.coverage.netlists import in_verilator

        icarus_level.start = in_verilator


def pytest_collection_modifyitems(config, items):
    from rtl.icarus import MISSING, installed

    in_icarus = [item for item in items if getattr(item.cls, "verilog", None) == "icarus"]
    if config.getoption("netlist"):
        config.hook.pytest_deselected(items=[item for item in items if item not in in_icarus])
        items[:] = in_icarus
    if not config.getoption("all"):
        slow = [item for item in items if item.get_closest_marker("slow")]
        config.hook.pytest_deselected(items=slow)
        items[:] = [item for item in items if item not in slow]
    if not installed():
        for item in in_icarus:
            item.add_marker(pytest.mark.skip(reason=MISSING))


def pytest_sessionfinish(session):
    """A netlist that no test took has not been tested (in one process: workers share the tests)."""
    options = session.config.option
    if not options.netlist or options.collectonly or getattr(options, "dist", "no") != "no":
        return
    from rtl.icarus_level import asked, netlists

    if unused := sorted(set(netlists) - asked):
        raise pytest.UsageError(
            f"--netlist = {', '.join(unused)}: no test built that; built were: {', '.join(sorted(asked)) or 'none'}"
        )
