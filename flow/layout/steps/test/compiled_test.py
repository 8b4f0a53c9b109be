"""What the step compiles is what the extraction calls: a real layout's steps compile nothing more."""

from types import ModuleType

import pytest

from talbot.flow.layout.steps.compiled import Compiled
from talbot.models.compiled import Compiled as Loop
from talbot.signoff.parasitics import bins, capacitance, shapes, trees
from talbot.signoff.parasitics.test.extract_test import ROUTE, nets, top

pytestmark = pytest.mark.needs("layout")

# Where a module that needs it was left out before, Python has a part of it: its import raises nothing again
LOOPS = bins, capacitance, shapes, trees


def compiled(module: ModuleType) -> dict[str, int]:
    """How often each loop of a module was compiled in this process."""
    found = vars(module).values()
    return {loop.__name__: len(loop.compiled.signatures) for loop in found if isinstance(loop, Loop)}


def test_a_layout_after_it_compiles_nothing(tmp_path):
    assert Compiled().run({}, {}) == {}
    before = [compiled(module) for module in LOOPS]
    nets(tmp_path, top(*ROUTE))
    assert [compiled(module) for module in LOOPS] == before
    assert all(any(module.values()) for module in before)
