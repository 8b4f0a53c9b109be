"""A line changed in each kind of file on which the layout's steps depend: exactly these steps have another key."""

import shutil

import pytest

from talbot.base import sources
from talbot.base.paths import ROOT
from talbot.base.steps.runner import source_of
from talbot.flow.layout import chain
from talbot.flow.layout.design import design
from talbot.flow.layout.options import Options

OPTIONS = Options()
FOLDERS = "models", "rtl", "imaging", "memory", "pixels", "cells", "signoff", "flow", "verif", "talbot"
FRAMES = {"gate_frames", "stimulus"}


@pytest.fixture(scope="module")
def steps():
    """Every step of the chip's and of a block's layout, by name; steps at a corner once."""
    found = {}
    for name in ("asp_chip", "quad_divider"):
        chosen = design(name)
        for step in chain.all_steps(chosen, OPTIONS):
            found.setdefault(step.name.removesuffix("_" + OPTIONS.corners[0]), step)
    return {name: step for name, step in found.items() if not name.endswith(tuple(OPTIONS.corners))}


@pytest.fixture(scope="module")
def tree(tmp_path_factory):
    """A copy of the repository's sources, which `changed` leaves as it was."""
    root = tmp_path_factory.mktemp("tree")
    for folder in FOLDERS:
        shutil.copytree(ROOT / folder, root / folder, True, shutil.ignore_patterns("__pycache__"))
    for name in ("conftest.py", "pyproject.toml"):
        shutil.copy(ROOT / name, root)
    return root


@pytest.fixture(scope="module")
def step_keys(steps, tree):
    """(a function that returns the key of each step, what it returns for the tree as it is)."""
    return with_result(lambda: {name: source_of(step, tree) for name, step in steps.items()})


@pytest.fixture(scope="module")
def cache_keys(tree):
    """The same of each of CACHES."""
    return with_result(lambda: {name: sources.code(*starts, root=tree) for name, starts in CACHES.items()})


def with_result(keys):
    return keys, keys()


def changed(keys, tree, file):
    """Names of the keys that change with one more line in ``file``."""
    now, before = keys
    path = tree / file
    text = path.read_text()
    path.write_text(text + ("\nCHANGED = True\n" if path.suffix == ".py" else "\n"))
    sources.forget(path, tree)
    try:
        after = now()
    finally:
        path.write_text(text)
        sources.forget(path, tree)
    return {name for name in before if before[name] != after[name]}


# file -> steps that must run again, and no other; ALL: every one
EXACTLY = [
    ("flow/layout/steps/drc.py", {"drc"}),
    ("models/chip.py", FRAMES),
    ("models/capture/operator.py", {"stimulus"}),
    ("imaging/simulate/bench.sv", FRAMES),
    ("pixels/afe.sv", FRAMES),
    ("signoff/netlist/routed.py", {"stream_out", "routed_stream_out"}),
    ("flow/layout/power/mesh.py", {"ir_drop"}),
    ("cells/characterize/constraint.py", {"timing"}),
    ("cells/report/curve.py", set()),
    ("cells/compact/route.py", {"library"}),
    ("talbot/platforms/ihp_sg13g2/layers.py", set()),
    ("verif/formal/engine.py", set()),
    ("talbot/__main__.py", set()),
]


@pytest.mark.parametrize("file, expected", EXACTLY)
def test_exactly_these_steps_run_again(step_keys, tree, file, expected):
    assert changed(step_keys, tree, file) == expected


@pytest.mark.parametrize(
    "file, some, others",
    [
        (
            "talbot/platforms/sky130/layout.py",
            {"library", "stream_out", "fill", "drc", "extraction"},
            {"gate_frames", "sta"},
        ),
        ("rtl/quad_divider/test/quad_divider_test.py", {"gate_tests_final_icarus"}, {"drc", "gate_frames"}),
        ("signoff/netlist/netlist.py", {"synthesis", "lvs", "stream_out"}, {"drc", "timing"}),
        ("models/parameters/checks.py", {"drc", "sta", "gate_frames", "timing"}, set()),
    ],
)
def test_these_steps_run_again_and_those_do_not(step_keys, tree, file, some, others):
    found = changed(step_keys, tree, file)
    assert some <= found and not others & found


# What the keys of the other caches are made of: modules, and tests of a block, whose code decides a kept result
CACHES = {
    "simulator": ("talbot.imaging.simulate.verilator",),
    "divider": ("talbot.imaging.simulate.divider.simulator",),
    "cell": ("talbot.cells.characterize.job",),
    "proof": ("talbot.verif.formal.prove",),
    "mutant": ("talbot.verif.mutation.judge", "rtl/edge_adc/test"),
    "coverage": ("talbot.verif.coverage.measure",),
    "trace": ("talbot.verif.coverage.traces", "rtl/edge_adc/test"),
    "fuzz": ("talbot.verif.fuzz.batch",),
}


@pytest.mark.parametrize(
    "file, expected",
    [
        ("rtl/edge_adc/edge_adc_rtl.py", {"simulator", "mutant", "trace"}),
        ("models/digital/sar.py", {"mutant", "trace"}),
        ("models/digital/stream/decode.py", {"fuzz"}),
        ("imaging/simulate/bench.sv", {"simulator"}),
        ("imaging/simulate/divider/main.cpp", {"divider", "mutant"}),
        ("cells/spice/engine.py", {"cell"}),
        ("verif/formal/engine.py", {"proof", "mutant"}),
        ("verif/verilated/main.cpp", {"coverage", "mutant", "trace"}),  # conftest.py can run netlists in that program
        ("flow/layout/chain.py", set()),
    ],
)
def test_exactly_these_caches_have_another_key(cache_keys, tree, file, expected):
    assert changed(cache_keys, tree, file) == expected
