"""Late nets: each change that gains is made, none that does not, and what is computed stays."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from talbot.base.liberty.read import read
from talbot.flow.layout.netlist.netlist import Instance
from talbot.flow.layout.repair.repair import OWN, connected
from talbot.flow.layout.repair.speed import NEXT, Delays, quickened
from talbot.flow.layout.repair.test.repair_test import chain, check_places, drives, liberty, source

ALONE = {"inv_x1": 0.05, "inv_x4": 0.05, "buf_x1": 0.1, "buf_x4": 0.1}  # ns without a load
NS_PF = {"inv_x1": 20.0, "inv_x4": 5.0, "buf_x1": 20.0, "buf_x4": 5.0}
DELAYS = Delays(
    {
        (cell, "nq" if cell.startswith("inv") else "q"): (np.array([0.0, 0.1]), np.array([ns, ns + 0.1 * NS_PF[cell]]))
        for cell, ns in ALONE.items()
    }
)
LATE = {("first", "nq"): -1.0, ("first", "i"): -1.0}


def slow(plan, net):
    """What a net costs, ns."""
    driver, pin, sinks = connected(plan.instances)[net]
    return DELAYS.ns(plan.instances[driver].cell, pin, plan.load(drives(), net, [plan.point(driver)], sinks))


@given(st.lists(st.tuples(st.floats(5, 390), st.floats(-1, 2)), min_size=2, max_size=30), st.integers(1, 4))
def test_functions_and_places_stay(sinks, rounds):
    plan, table = chain([200.0, *(x for x, _ in sinks)]), drives()
    before = {i.name: i.pins["i"] for i in plan.instances.values()}
    slacks = LATE | {(f"u{k}", "i"): slack for k, (_, slack) in enumerate(sinks)}
    for _ in range(rounds):
        ends = {(name, pin): -1.0 for name, i in plan.instances.items() for pin in i.pins if name.endswith(OWN)}
        quickened(plan, table, DELAYS, set(), ends | slacks, 0.0)
        for name, net in before.items():
            assert source(plan, plan.instances[name].pins["i"]) == net
        assert set(plan.instances) == set(plan.places)
        check_places(plan)


def test_a_larger_driver_where_it_gains():
    plan = chain([10.0, 80.0])
    quickened(plan, drives(), DELAYS, set(), LATE, 0.0)
    assert plan.instances["first"].cell == "inv_x4" and len(plan.instances) == 2


@pytest.mark.parametrize(("kept", "slack"), [({"n"}, -1.0), (set(), 0.1)])
def test_what_is_kept_or_not_late_stays(kept, slack):
    plan = chain([10.0, 80.0])
    quickened(plan, drives(), DELAYS, kept, {("first", "nq"): slack}, 0.0)
    assert plan.instances["first"].cell == "inv_x1" and len(plan.instances) == 2


def test_sinks_that_can_wait_are_behind_a_buffer():
    plan = chain([10.0, 12.0, *[350.0] * 4])
    plan.instances["first"] = Instance("first", "inv_x4", plan.instances["first"].pins)
    before = slow(plan, "n")
    quickened(
        plan, drives(), DELAYS, set(), LATE | {("u0", "i"): -1.0} | {(f"u{k}", "i"): 1.0 for k in range(1, 5)}, 0.0
    )
    assert plan.instances["u0"].pins["i"] == "n" and slow(plan, "n") < before
    assert "n" not in {plan.instances[f"u{k}"].pins["i"] for k in range(1, 5)}


def test_a_buffer_that_costs_more_than_it_saves_is_taken_away():
    plan = chain([10.0, 14.0])
    pins = plan.instances["u0"].pins
    plan.put(Instance(f"n_0{OWN}", "buf_x1", {"i": "n", "q": "n_0"}), (12.0, 4.0))
    plan.instances["u0"] = Instance("u0", "inv_x1", pins | {"i": "n_0"})
    quickened(plan, drives(), DELAYS, set(), {(f"n_0{OWN}", "q"): -1.0, (f"n_0{OWN}", "i"): -1.0}, 0.0)
    assert set(plan.instances) == {"first", "u0"} and plan.instances["u0"].pins["i"] == "n"
    check_places(plan)


def test_a_larger_driver_that_slows_the_one_before_more_is_not_taken():
    plan = chain([10.0, 30.0])
    plan.put(Instance("before", "inv_x1", {"i": "a", "nq": "b"}), (8.0, 4.0))
    plan.instances["first"] = Instance("first", "inv_x1", {"i": "b", "nq": "n"})
    heavy = drives()
    inputs = {**heavy.inputs, ("inv_x4", "i"): 0.1}
    quickened(plan, type(heavy)(inputs, heavy.limits, heavy.sizes), DELAYS, set(), LATE, 0.0)
    assert plan.instances["first"].cell == "inv_x1"
    quickened(plan, heavy, DELAYS, set(), LATE, 0.0)
    assert plan.instances["first"].cell == "inv_x4"


def test_delays_are_those_of_the_tables(tmp_path):
    """Slews and delays of the library are equal: 0.1 ns and 10 ns/pF, at inputs of 1 ns 0.1 ns more."""
    found = Delays.of(read(liberty(tmp_path / "l.lib")))
    at = 0.1 + 0.1 * (0.2 - 0.1) / (1.0 - 0.1)
    assert found.ns("inv_x1", "nq", 0.0) == pytest.approx((1 + NEXT) * at)
    assert found.ns("inv_x1", "nq", 0.2) == pytest.approx((1 + NEXT) * (at + 2.0))
    assert found.ns("inv_x4", "nq", 0.8) == pytest.approx((1 + NEXT) * (at + 2.0))  # beyond the table
