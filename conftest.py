"""Options of the tests: slow ones, and netlists instead of the translated Verilog.

A property fails immediately with the first input that breaks it. --hypothesis-profile=smallest looks for the smallest
one, which takes minutes with a simulator. Where a CI runs the tests, Hypothesis draws the same inputs every time,
whatever --hypothesis-seed says, but with --hypothesis-profile=seeded.
"""

import gc
import os
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


@pytest.fixture(autouse=True, scope="session")
def every_page_is_checked():
    """Fail a test that makes a page with a request, a picture without a text or a table without a box."""
    from jinja2 import Template

    from talbot.base.page import FOLDER
    from talbot.base.page.check import faults

    plain = Template.render

    def render(self, *args, **values):
        text = plain(self, *args, **values)
        if str(FOLDER) in getattr(self.environment.loader, "searchpath", ()) and text.startswith("<!DOCTYPE html>"):
            assert not (found := faults(text)), f"{self.name}: {'; '.join(found)}"
        return text

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Template, "render", render)
        yield


@pytest.fixture(autouse=True)
def environment_is_restored():
    """Fail a test that leaves the environment changed: later tests of its process would find other caches or tools."""
    before = dict(os.environ)
    yield
    changed = {name for name, _ in before.items() ^ os.environ.items()} - {"PYTEST_CURRENT_TEST"}
    names = {name for name in changed if name in before or name.startswith("TALBOT")}  # libraries set others
    if names:
        os.environ.clear()
        os.environ.update(before)
        pytest.fail(f"the test left the environment changed: {', '.join(sorted(names))}")


PACKAGE = Path(__file__).parent / "talbot"
NETLISTS = pytest.StashKey()  # rtl.harness.netlists.Netlists of --netlist


def pytest_addoption(parser):
    parser.addoption("--all", action="store_true", help="also run the tests marked slow (make verify)")
    group = parser.getgroup("netlists", "run the Icarus level of the tests on netlists")
    group.addoption(
        "--netlist",
        action="append",
        default=[],
        metavar="NAME=FILE[:MODULE]",
        help="Verilog instead of what the tests build as NAME (rtl/harness/README.md): AmpCtrl=gates.v",
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
    from talbot.verif.needs import SLOW

    in_icarus = [item for item in items if getattr(item.cls, "verilog", None) == "icarus"]
    if config.getoption("netlist"):
        config.hook.pytest_deselected(items=[item for item in items if item not in in_icarus])
        items[:] = in_icarus
    if not config.getoption("all"):
        for item in items:
            if item.get_closest_marker("slow"):
                item.add_marker(pytest.mark.skip(reason=SLOW))
    for item in in_icarus:
        item.add_marker(pytest.mark.needs("iverilog"))


@pytest.fixture
def given_verilog(request):
    """given_verilog(name): files of the netlist instead of what a test builds as ``name``; [] where none are given."""
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
    """Fail for a netlist that no test used (in one process: workers share the tests)."""
    options = session.config.option
    if not options.netlist or options.collectonly or getattr(options, "dist", "no") != "no":
        return
    netlists = session.config.stash[NETLISTS]
    if unused := netlists.unused():
        raise pytest.UsageError(
            f"--netlist = {', '.join(unused)}: no test builds that; built were: "
            f"{', '.join(sorted(netlists.built)) or 'none'}"
        )
