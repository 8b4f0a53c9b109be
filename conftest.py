"""Tests that are slow run with --all. The Icarus level of the blocks' tests runs on netlists on demand; where Icarus

is missing it is skipped with the reason. A property fails with the first input that breaks it, at once;
--hypothesis-profile=smallest looks for the smallest one, which takes minutes where a simulator has to run.
"""

import importlib.util
from pathlib import Path

import pytest
from hypothesis import Phase, settings

settings.register_profile("first", phases=[Phase.explicit, Phase.reuse, Phase.generate])
settings.register_profile("smallest", phases=list(Phase))
settings.load_profile("first")

# These draw and read layouts: KLayout's Python module comes with the environment of cells and layouts
LAYOUTS = "cells/extract", "cells/compact", "cells/lef", "cells/test"
NETLISTS = pytest.StashKey()  # rtl.harness.netlists.Netlists of --netlist
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
    group.addoption(
        "--cells", action="append", default=[], type=Path, metavar="FILE", help="models of the netlists' cells"
    )


def pytest_configure(config):
    config.addinivalue_line("markers", "slow: runs with --all only")
    if not config.getoption("netlist"):
        return
    from models.parameters import ParameterError
    from rtl.harness.netlists import Netlists, netlist, netlist_in_icarus
    from rtl.harness.testbench import hooked
    from verif.coverage.netlists import netlist_in_verilator

    simulate = netlist_in_verilator if config.getoption("netlist_in") == "verilator" else netlist_in_icarus
    try:
        netlists = {given.name: given for given in map(netlist, config.getoption("netlist"))}
    except ParameterError as error:
        raise pytest.UsageError(str(error)) from None
    config.stash[NETLISTS] = Netlists(netlists, config.getoption("cells"), simulate)
    substitutes = hooked(substitute=config.stash[NETLISTS].substitute)
    substitutes.__enter__()
    config.add_cleanup(lambda: substitutes.__exit__(None, None, None))


def pytest_collection_modifyitems(config, items):
    from rtl.harness.icarus import MISSING, installed

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
    netlists = session.config.stash[NETLISTS]
    if unused := netlists.unused():
        raise pytest.UsageError(
            f"--netlist = {', '.join(unused)}: no test built that; built were: "
            f"{', '.join(sorted(netlists.built)) or 'none'}"
        )
