"""Arrange: places stay legal, nets get short, fixed cells and those of other libraries stay."""

import random

import pytest

from talbot.base.steps import StepError
from talbot.flow.layout.geometry.rows import Rows
from talbot.flow.layout.netlist.netlist import Instance
from talbot.flow.layout.repair.arrange import arranged
from talbot.flow.layout.repair.repair import Plan
from talbot.flow.layout.repair.test.repair_test import ROW, SITE, WIDTHS, check_places

pytestmark = pytest.mark.needs("coriolis")


def scattered(seed):
    """A chain of 150 inverters and flip-flops at random places in four rows; a macro; rows turned by turns."""
    draw, rows = random.Random(seed), Rows(SITE, ROW)
    for k in range(4):  # a turned cell's origin is its upper edge
        rows.give(400.0, (0.0, (k + k % 2) * ROW, "6" if k % 2 else "0"))
    plan = Plan({}, {}, WIDTHS, rows, {"n0": (0.0, 6.0), "n150": (400.0, 6.0)})
    for k in range(150):
        pins = {"i": f"n{k}", "nq": f"n{k + 1}"} | ({"clk": "clk"} if k % 5 == 0 else {})
        cell = "dff_x1" if k % 5 == 0 else draw.choice(("inv_x1", "inv_x4"))
        assert plan.put(Instance(f"u{k}", cell, pins), (draw.uniform(0, 390), draw.uniform(0, 12)))
    assert plan.put(Instance("tree", "buf_x4", {"i": "root", "q": "clk"}), (200.0, 6.0))
    return plan


@pytest.mark.parametrize("spread", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("seed", range(3))
def test_nets_get_short_and_places_stay_legal(seed, spread):
    plan = scattered(seed)
    before, tree = sum(plan.lengths().values()), plan.places["tree"]
    arranged(plan, {"tree"}, 3, spread)
    check_places(plan)
    assert plan.places["tree"] == tree
    assert sum(plan.lengths().values()) < 0.6 * before


def longest_gap(plan):
    return max(end - begin for spans in plan.rows.rows.values() for begin, end in spans)


def test_what_is_spread_has_its_gaps_between_cells():
    packed, spread = scattered(1), scattered(1)
    for plan in (packed, spread):  # nothing pulls to the other end
        plan.ports = {"n0": (0.0, 6.0)}
    arranged(packed, {"tree"}, 3, 0.0)
    arranged(spread, {"tree"}, 3, 1.0)
    assert longest_gap(spread) < longest_gap(packed) / 2


def test_a_macro_stays_and_pulls():
    plan = scattered(2)
    plan.instances["macro"], plan.places["macro"] = Instance("macro", "block", {"a": "n75"}), (390.0, 0.0, "0")
    arranged(plan, {"tree"}, 3, 0.0)
    assert plan.places["macro"] == (390.0, 0.0, "0")
    check_places(Plan({k: v for k, v in plan.instances.items() if k != "macro"},
                      {k: v for k, v in plan.places.items() if k != "macro"}, WIDTHS, plan.rows, {}))  # fmt: skip


def test_a_taken_place_is_not_given_again():
    rows = Rows(SITE, ROW)
    rows.give(10.0, (0.0, 0.0, "0"))
    rows.claim(4.0, (3.0, 0.0, "0"))
    assert rows.rows == {(0.0, "0"): [[0, 6], [14, 20]]}
    for x in (2.0, 5.0, 9.0):
        with pytest.raises(StepError, match="no place for a cell of 4 um"):
            rows.claim(4.0, (x, 0.0, "0"))
