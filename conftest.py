"""Options of the tests: slow ones, netlists in place of the translated Verilog, and tests skipped for lack of a tool.

A property fails immediately with the first input that breaks it. --hypothesis-profile=smallest looks for the smallest
one, which takes minutes with a simulator. Where a CI runs the tests, Hypothesis draws the same inputs every time,
whatever --hypothesis-seed says, but with --hypothesis-profile=seeded.
"""

import gc
import importlib.util
import os
import re
from collections import Counter
from pathlib import Path

import pytest
from hypothesis import Phase, settings

settings.register_profile("first", deadline=None, phases=[Phase.explicit, Phase.reuse, Phase.generate])
settings.register_profile("seeded", settings.get_profile("first"), derandomize=False)
settings.register_profile("smallest", deadline=None, phases=list(Phase))
settings.load_profile("first")

# A worker has one core: with a thread a core, threads of NumPy's BLAS wait, busily, for those of other workers (NumPy,
# which reads this, is not imported yet). Results are those of one thread on any machine, too.
for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ.setdefault(name, "1")

# Collection makes objects that all stay: to look for cycles among them took a third of its time
gc.disable()

# These draw and read layouts: KLayout's Python module comes with the environment of cells and layouts
LAYOUTS = "talbot/cells/extract", "talbot/cells/compact", "talbot/cells/lef", "talbot/cells/test"
PACKAGE = Path(__file__).parent / "talbot"
NETLISTS = pytest.StashKey()  # rtl.harness.netlists.Netlists of --netlist
SLOW = "slow: make verify, or pytest --all"
# What neither Debian nor PyPI has, a machine cannot do, or is too large to ask for: skipped with --complete, too
ELSEWHERE = re.compile(
    r"slow|benchmark|PDK_ROOT|TT_TOOLS|openroad|PyTorch|Mitsuba|a small file system cannot be mounted|needs /proc"
    r"|no coriolis for"
)
# Command that brings what a test was skipped for, by a word of its reason
BRINGS = {
    "slow": "make verify",
    "benchmark": "make bench",
    "LibreLane": "make librelane",
    "PyTorch": "pip install 'talbot[nn]'",
    "Mitsuba": "make render",
    "TT_TOOLS": "TT_TOOLS=<tt-support-tools> PDK_ROOT=<an installed PDK>",
    "PDK_ROOT": "PDK_ROOT=<an installed PDK>",
} | dict.fromkeys(
    ("klayout", "c4m", "pdkmaster", "coriolis", "sky130"), "make setup-layout (klayout's program: make tools)"
)
LAYOUT_PACKAGES = {"klayout", "c4m", "pdkmaster", "coriolis", "coloquinte", "sky130"}
collect_ignore = [] if importlib.util.find_spec("klayout") else list(LAYOUTS)


def pytest_addoption(parser):
    parser.addoption("--all", action="store_true", help="also run the tests marked slow (make verify)")
    parser.addoption(
        "--complete", action="store_true", help="fail where a test is skipped for want of a tool or package"
    )
    group = parser.getgroup("netlists", "run the Icarus level of the tests on netlists")
    group.addoption(
        "--netlist",
        action="append",
        default=[],
        metavar="NAME=FILE[:MODULE]",
        help="Verilog in place of what the tests build as NAME (rtl/harness/README.md): AmpCtrl=gates.v",
    )
    group.addoption(
        "--netlist-in",
        choices=("icarus", "verilator"),
        default="icarus",
        help="simulator of the netlists; Verilator is two-valued, without X (%(default)s)",
    )
    group.addoption(
        "--cells", action="append", default=[], type=Path, metavar="FILE", help="models of the netlists' cells"
    )


def pytest_configure(config):
    config.addinivalue_line("markers", "slow: runs with --all only")
    config.args[:] = [in_package(argument, config.invocation_params.dir) for argument in config.args]
    if not config.getoption("netlist"):
        return
    from talbot.models.parameters import ParameterError
    from talbot.rtl.harness.netlists import Netlists, netlist, netlist_in_icarus
    from talbot.rtl.harness.testbench import hooked
    from talbot.verif.coverage.netlists import netlist_in_verilator

    simulate = netlist_in_verilator if config.getoption("netlist_in") == "verilator" else netlist_in_icarus
    try:
        netlists = {given.name: given for given in map(netlist, config.getoption("netlist"))}
    except ParameterError as error:
        raise pytest.UsageError(str(error)) from None
    config.stash[NETLISTS] = Netlists(netlists, config.getoption("cells"), simulate)
    substitutes = hooked(substitute=config.stash[NETLISTS].substitute)
    substitutes.__enter__()
    config.add_cleanup(lambda: substitutes.__exit__(None, None, None))


def in_package(argument, folder):
    """``argument``, a path from ``folder`` or a node id, through its part's link: models/x_test.py::test is
    talbot/models/x_test.py::test, so that no file is imported as two modules."""
    name, *node = argument.partition("::")
    path = Path(os.path.relpath(folder / name, PACKAGE.parent))
    return f"{PACKAGE / path}{''.join(node)}" if PACKAGE.joinpath(*path.parts[:1]).is_symlink() else argument


@pytest.hookimpl(trylast=True)
def pytest_collection_finish():
    gc.freeze()
    gc.enable()


def pytest_collection_modifyitems(config, items):
    from talbot.rtl.harness.icarus import MISSING, installed

    in_icarus = [item for item in items if getattr(item.cls, "verilog", None) == "icarus"]
    if config.getoption("netlist"):
        config.hook.pytest_deselected(items=[item for item in items if item not in in_icarus])
        items[:] = in_icarus
    if not config.getoption("all"):
        for item in items:
            if item.get_closest_marker("slow"):
                item.add_marker(pytest.mark.skip(reason=SLOW))
    if not installed():
        for item in in_icarus:
            item.add_marker(pytest.mark.skip(reason=MISSING))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_setup(item):
    return (yield from skipped_without_layouts())


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item):
    return (yield from skipped_without_layouts())


def skipped_without_layouts():
    """Skip a test that comes to a package of the environment of layouts, where that is not installed.

    Data that the package holds is missed as a ToolError, whose cause names the package.
    """
    from talbot.base.tools import ToolError

    try:
        return (yield)
    except (ModuleNotFoundError, ToolError) as error:
        absent = error if isinstance(error, ModuleNotFoundError) else error.__cause__
        package = (getattr(absent, "name", None) or "").partition(".")[0]
        if package in LAYOUT_PACKAGES:
            pytest.skip(f"{package}: not installed")
        raise


@pytest.fixture
def given_verilog(request):
    """given_verilog(name): files of the netlist in place of what a test builds as ``name``; [] where none are given."""
    netlists = request.config.stash.get(NETLISTS, None)

    def files(name):
        found = netlists.files(name) if netlists else []
        if netlists and not found:
            pytest.skip(f"--netlist has none of {name}")
        return found

    return files


@pytest.fixture
def on_netlists(request):
    """on_netlists(configurations): those of them that run on a netlist, by their ``name``; all where none are given.

    The test is skipped where none is left: it would test something else than the netlist.
    """
    netlists = request.config.stash.get(NETLISTS, None)

    def chosen(configurations):
        found = [one for one in configurations if not netlists or one.name in netlists.netlists]
        if not found:
            pytest.skip(f"--netlist has none of {', '.join(one.name for one in configurations)}")
        return found

    return chosen


def pytest_sessionfinish(session):
    """Fail for a netlist that no test used (in one process: workers share the tests), and with --complete for a gap."""
    options = session.config.option
    if options.complete and not hasattr(session.config, "workerinput") and session.exitstatus == 0:
        session.exitstatus = int(bool(missing(session.config.pluginmanager.get_plugin("terminalreporter"))))
    if not options.netlist or options.collectonly or getattr(options, "dist", "no") != "no":
        return
    netlists = session.config.stash[NETLISTS]
    if unused := netlists.unused():
        raise pytest.UsageError(
            f"--netlist = {', '.join(unused)}: no test builds that; built were: "
            f"{', '.join(sorted(netlists.built)) or 'none'}"
        )


def skipped(reporter):
    """(reason, how many tests), the most frequent first; a module that is skipped whole counts once."""
    reasons = Counter(f"{folder}: klayout is not installed" for folder in collect_ignore)
    for report in reporter.stats.get("skipped", ()):
        reason = report.longrepr[2] if isinstance(report.longrepr, tuple) else str(report.longrepr)
        reasons[reason.removeprefix("Skipped: ").splitlines()[0]] += 1
    return reasons.most_common()


def missing(reporter):
    """Reasons that a package of Debian or PyPI would remove."""
    return [reason for reason, _ in skipped(reporter) if not ELSEWHERE.search(reason)]


def pytest_terminal_summary(terminalreporter, config):
    """Print what was left out and the command that brings it."""
    for reason, count in () if config.getoption("netlist") else skipped(terminalreporter):
        command = next((command for word, command in BRINGS.items() if word in reason), "make tools")
        suffix = "" if "make" in reason else f" ({command})"
        terminalreporter.write_line(f"left out: {count} x {reason}{suffix}")
    if config.getoption("complete") and (gaps := missing(terminalreporter)):
        terminalreporter.write_line(f"--complete: {len(gaps)} reasons to skip that a package removes: this run fails")
