"""Registers grouped by their places: what clocks them stays, no group is too large, no cell without a place."""

from collections import Counter, defaultdict

import pytest
from hypothesis import given
from hypothesis import strategies as st

from talbot.base.steps import StepError
from talbot.flow.layout.geometry.rows import Rows
from talbot.flow.layout.netlist.gating import ClockCells, ClockGate
from talbot.flow.layout.netlist.netlist import Buffer, Instance
from talbot.flow.layout.repair.clock import regrouped
from talbot.flow.layout.repair.drive import Drives
from talbot.flow.layout.repair.repair import Plan, connected

SIZES = [ClockCells(ClockGate(f"cg_{x}", "i", "clk", "q"), Buffer(f"buf_{x}", "i", "q")) for x in ("x1", "x2")]
WIDTHS = {"cg_x1": 6.0, "cg_x2": 7.0, "buf_x1": 1.5, "buf_x2": 2.0, "buf_x4": 3.0, "buf_x8": 5.0, "dff_x1": 9.0}
LIMITS = {"cg_x1": 0.02, "buf_x1": 0.02, "cg_x2": 0.04, "buf_x2": 0.04, "buf_x4": 0.06, "buf_x8": 0.2}  # pF
PINS = {("dff_x1", "clk"): 0.002, ("cg_x1", "clk"): 0.004, ("cg_x2", "clk"): 0.004}
PINS |= {("buf_x4", "i"): 0.02, ("buf_x8", "i"): 0.02}
DRIVES = Drives(PINS, {(cell, "q"): limit for cell, limit in LIMITS.items()}, {"buf_x4": ["buf_x8"], "buf_x8": []})
ROW, MOST = 3.0, 4


def tree(registers, rows=12):
    """A tree of two leaves at random places; registers: x, row and number of the enable of each, 0 for none."""
    free = Rows(0.5, ROW)
    for y in range(rows):
        free.give(400.0, (0.0, y * ROW, "0"))
    plan = Plan({}, {}, WIDTHS, free, {"clk": (0.0, 0.0)}, 0.2, {})
    plan.put(Instance("root", "buf_x4", {"i": "clk", "q": "top"}), (200.0, 15.0))
    for k, x in enumerate((100.0, 300.0)):
        plan.put(Instance(f"leaf{k}", "buf_x4", {"i": "top", "q": f"l{k}"}), (x, 15.0))
    for k, (x, row, enable) in enumerate(registers):
        driver = f"u{enable}"
        if driver not in plan.instances:
            source = {"i": f"l{enable % 2}"} if enable == 0 else {"i": f"e{enable}", "clk": f"l{enable % 2}"}
            plan.put(Instance(driver, "cg_x1" if enable else "buf_x1", source | {"q": f"c{enable}"}), (200.0, 15.0))
        plan.put(Instance(f"r{k}", "dff_x1", {"i": "d", "clk": f"c{enable}", "q": f"q{k}"}), (x, row * ROW))
    return plan


def clocks(plan):
    """By register the cell that drives its clock and its net of the enable; by driver its registers."""
    nets, found, groups = connected(plan.instances), {}, defaultdict(list)
    for name, instance in plan.instances.items():
        if instance.cell == "dff_x1":
            driver = plan.instances[nets[instance.pins["clk"]][0]]
            found[name] = driver.cell.partition("_")[0], driver.pins["i"] if driver.cell.startswith("cg") else ""
            groups[driver.name].append(name)
    return found, groups


@given(st.lists(st.tuples(st.floats(5, 380), st.integers(0, 11), st.integers(0, 3)), min_size=1, max_size=60))
def test_registers_keep_their_clock(registers):
    plan = tree(registers)
    (before, drivers), roots = clocks(plan), {"l0", "l1"}
    used = {pins.get("clk", pins["i"]) for pins in (plan.instances[name].pins for name in drivers)}
    added = regrouped(plan, DRIVES, SIZES, MOST)
    after, groups = clocks(plan)
    assert after == before and len(groups) == len(drivers) + added
    for name, sinks in groups.items():
        cell, ends = plan.instances[name].cell, [(sink, "clk") for sink in sinks]
        load = plan.load(DRIVES, "", [plan.point(name)], ends)
        assert len(sinks) <= MOST and (
            load <= LIMITS[cell] + 0.2 * 0.04 or len(sinks) == 1
        )  # the place is not quite it
    leaves = Counter(i.pins.get("clk", i.pins["i"]) for i in map(plan.instances.get, groups))
    assert set(leaves) <= used <= roots and max(leaves.values()) <= -(-1.25 * len(groups) // len(used))
    nets = connected(plan.instances)
    for net in ("l0", "l1", "top"):
        driver, _, sinks = nets[net]
        within = plan.load(DRIVES, "", [plan.point(driver)], sinks) <= LIMITS["buf_x4"] + 0.2 * 0.01
        assert plan.instances[driver].cell == "buf_x8" or within
    taken = [
        (y, x + 0.5 * k)
        for n, (x, y, _) in plan.places.items()
        for k in range(round(2 * WIDTHS[plan.instances[n].cell]))
    ]
    assert len(taken) == len(set(taken)) and set(plan.places) == set(plan.instances)


def test_near_registers_share_a_driver():
    plan = tree([(x, 2, 0) for x in (10.0, 350.0, 20.0, 360.0, 30.0, 370.0)])
    assert regrouped(plan, DRIVES, SIZES, MOST) == 1
    assert sorted(map(sorted, clocks(plan)[1].values())) == [["r0", "r2", "r4"], ["r1", "r3", "r5"]]


def test_a_driver_without_room_is_an_error():
    plan = tree([(x, 0, 1) for x in (10.0, 350.0)], rows=1)
    plan.rows.rows.clear()
    with pytest.raises(StepError, match="no room in the rows for u1_1, which drives the clock of 1 registers"):
        regrouped(plan, DRIVES, SIZES, MOST)
