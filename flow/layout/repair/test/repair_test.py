"""Repair: loads end within what drivers take, functions stay, places neither overlap nor leave their rows."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from talbot.base.liberty.read import read
from talbot.flow.layout.geometry.rows import Rows, free_rows
from talbot.flow.layout.netlist.netlist import Instance, Netlist, Port
from talbot.flow.layout.repair.drive import Drives
from talbot.flow.layout.repair.repair import (
    HALFWAY,
    OWN,
    Plan,
    borne,
    clock_nets,
    connected,
    eased,
    length,
    repaired,
    shortened,
    swap,
)
from talbot.flow.layout.timing.constraints import sdc
from talbot.flow.layout.timing.estimate import setup_slack, setup_slacks

SITE, ROW = 0.5, 3.0
WIDTHS = {"inv_x1": 1.0, "inv_x4": 2.0, "buf_x1": 1.5, "buf_x4": 3.0, "dff_x1": 9.0, "tie": 0.5, "tie_w4": 2.0}
LIMITS = {"inv_x1": 0.01, "inv_x4": 0.04, "buf_x1": 0.01, "buf_x4": 0.04, "dff_x1": 0.01}  # pF
FILL = "tie", "tie_w4"
INVERTER = """cell(inv_x{size}) {{ area : 1; pin(i) {{ direction : input; capacitance : 0.001; }}
  pin(nq) {{ direction : output; function : "!i"; max_capacitance : 0.3; timing() {{ related_pin : "i";
    {tables} }} }} }}"""
LIBRARY = """library(l) {{ delay_model : table_lookup; time_unit : "1ns"; capacitive_load_unit(1, pf); {percent}
  voltage_unit : "1V"; current_unit : "1mA"; leakage_power_unit : "1nW"; nom_voltage : 1.8;
  lu_table_template(t) {{ variable_1 : input_net_transition; variable_2 : total_output_net_capacitance;
    index_1("0.1, 1.0"); index_2("0.0, 0.4"); }}
  {cells} }}"""


def liberty(path):
    """inv_x1: a slew of 0.1 ns and 10 ns/pF, inv_x4 a quarter of this; at inputs of 1 ns 0.1 ns more. Delay as slew."""
    cells = []
    for size in (1, 4):
        rows = [", ".join(str(slow + 0.1 + 10 / size * load) for load in (0, 0.4)) for slow in (0.0, 0.1)]
        values = 'index_1("0.1, 1.0"); index_2("0.0, 0.4"); values("' + '", "'.join(rows) + '");'
        kinds = "cell_rise", "cell_fall", "rise_transition", "fall_transition"
        cells.append(INVERTER.format(size=size, tables=" ".join(f"{kind}(t) {{ {values} }}" for kind in kinds)))
    percent = "".join(
        f"{name}_threshold_pct_{edge} : {value}; "
        for edge in ("rise", "fall")
        for name, value in (("input", 50), ("output", 50), ("slew_lower", 20), ("slew_upper", 80))
    )
    path.write_text(LIBRARY.format(cells="\n".join(cells), percent=percent))
    return path


def drives():
    inputs = {(cell, "i"): 0.001 for cell in LIMITS}
    outputs = {(cell, "nq" if cell.startswith("inv") else "q"): limit for cell, limit in LIMITS.items()}
    return Drives(
        inputs, outputs, {"inv_x1": ["inv_x4"], "buf_x1": ["buf_x4"], "inv_x4": [], "buf_x4": [], "dff_x1": []}
    )


def chain(xs):
    """Inverters at ``xs`` (um), the first of which drives all others; rows of 400 um with empty places."""
    instances = {"first": Instance("first", "inv_x1", {"i": "a", "nq": "n"})}
    instances |= {f"u{k}": Instance(f"u{k}", "inv_x1", {"i": "n", "nq": f"z{k}"}) for k in range(len(xs) - 1)}
    rows, places = Rows(SITE, ROW), {}
    for y in range(4):
        rows.give(400.0, (0.0, y * ROW, "0"))
    plan = Plan({}, places, WIDTHS, rows, {"a": (0.0, 0.0)}, 0.2, {})
    for (name, instance), x in zip(instances.items(), xs, strict=True):
        assert plan.put(instance, (x, 4.0)), name
    return plan


def source(plan, net):
    """The net that ``net`` is a copy of by buffers."""
    copies = {i.pins["q"]: i.pins["i"] for i in plan.instances.values() if i.cell.startswith("buf")}
    while net in copies:
        net = copies[net]
    return net


def check_places(plan):
    """No two cells share a site, and with the empty places they are all sites."""
    taken = set()
    for name, (x, *row) in plan.places.items():
        sites = {(*row, round(x / SITE) + k) for k in range(round(WIDTHS[plan.instances[name].cell] / SITE))}
        assert not sites & taken
        taken |= sites
    fill = plan.rows.filled({cell: WIDTHS[cell] for cell in FILL})
    for cell, (x, *row) in fill:
        sites = {(*row, round(x / SITE) + k) for k in range(round(WIDTHS[cell] / SITE))}
        assert not sites & taken
        taken |= sites
    assert len(taken) == 4 * 400 / SITE


@pytest.mark.parametrize(
    ("size", "um", "after", "buffers"),
    [
        ("inv_x1", 15, "inv_x1", 0),
        ("inv_x1", 40, "inv_x4", 0),
        ("inv_x4", 120, "inv_x4", 0),
        ("inv_x4", 155, "inv_x4", 1),
    ],
)
def test_drivers_bear_a_detour(size, um, after, buffers):
    """Twice the wire by a larger driver; where none is, 1.4 times, else a buffer takes the sink."""
    plan, table = chain([5, um]), drives()
    swap(plan, "first", size)
    assert eased(plan, table, {"n"}) == 0
    assert eased(plan, table, set()) == (after != size) + buffers
    assert plan.instances["first"].cell == after
    assert sum(name.endswith(OWN) for name in plan.instances) == buffers
    assert source(plan, plan.instances["u0"].pins["i"]) == "n"
    check_places(plan)


@given(st.lists(st.floats(5, 390), min_size=2, max_size=30))
def test_loads_end_within_limits(xs):
    plan, table = chain(xs), drives()
    before = {i.name: i.pins["i"] for i in plan.instances.values()}
    counts = repaired(plan, table, set())
    for net, (driver, pin, sinks) in connected(plan.instances).items():
        cell = plan.instances[driver].cell
        alone = len(sinks) == 1  # a wire that is longer than the largest buffer drives
        assert plan.load(table, net, [plan.point(driver)], sinks) <= table.limits[cell, pin] or alone
    for name, net in before.items():
        assert source(plan, plan.instances[name].pins["i"]) == net
    assert counts["buffers"] == sum(name.endswith(OWN) for name in plan.instances)
    check_places(plan)


def test_the_smallest_larger_form_is_taken():
    plan = chain([10.0, 80.0])
    assert repaired(plan, drives(), set()) == {"sized": 1, "buffers": 0}
    assert plan.instances["first"].cell == "inv_x4"


def test_a_net_bears_the_length_at_which_its_load_is_the_limit():
    plan, table = chain([10.0, 20.0, 30.0]), drives()
    # inv_x1 drives 0.010 pF; its two sinks take 0.002 and the port, where it is one's, 0.003: 0.2 fF a um
    assert borne(plan, table)["n"] == pytest.approx(40.0)
    plan.outside = {"n": 0.003}
    assert borne(plan, table)["n"] == pytest.approx(25.0)
    plan.outside = {"n": 1.0}
    assert borne(plan, table)["n"] == 0


def test_a_net_that_is_kept_stays():
    plan = chain([10.0, 380.0])
    assert repaired(plan, drives(), {"n"}) == {"sized": 0, "buffers": 0}


def test_an_urgent_sink_does_not_wait_for_a_buffer():
    plan = chain([10.0, 30.0, *[350.0] * 8])
    slacks = {("first", "nq"): 0.0, ("u0", "i"): 0.0} | {(f"u{k}", "i"): 5.0 for k in range(1, 9)}
    assert repaired(plan, drives(), set(), slacks)["buffers"] > 0
    assert plan.instances["u0"].pins["i"] == "n" and plan.instances["u1"].pins["i"] != "n"


def test_a_loaded_output_has_a_buffer_of_its_own():
    plan = chain([10.0, 12.0])
    plan.ports, plan.outside = {"a": (0.0, 0.0), "n": (20.0, 0.0)}, {"n": 0.03}
    table = drives()
    table.sizes["inv_x1"] = []
    assert repaired(plan, table, set()) == {"sized": 0, "buffers": 1}
    buffer = plan.instances["n_0_repair"]
    assert buffer.cell == "buf_x4" and buffer.pins == {"i": "n_0", "q": "n"}
    assert plan.instances["first"].pins["nq"] == "n_0" and plan.instances["u0"].pins["i"] == "n"
    check_places(plan)


@pytest.mark.parametrize("turn", ["0", "6"])
def test_a_larger_form_stays_in_its_row(turn):
    """Rows upright and mirrored in turn, two of which begin at the same height."""
    rows = Rows(SITE, ROW)
    for k in range(1, 5):
        for place in ((0.0, 2 * k * ROW, "0"), (0.0, 2 * k * ROW, "6")):
            rows.give(400.0, place)
    places = {"u": (100.0, 4 * ROW, turn)}
    plan = Plan({"u": Instance("u", "inv_x1", {"i": "a", "nq": "n"})}, places, WIDTHS, rows, {}, 0.2, {})
    rows.take(1.0, 100.0, plan.point("u")[1])
    assert swap(plan, "u", "inv_x4") and plan.places["u"] == (99.5, 4 * ROW, turn)


def test_without_room_nothing_changes():
    plan = chain([10.0, 380.0])
    plan.rows = Rows(SITE, ROW)
    before = dict(plan.instances), dict(plan.places)
    assert repaired(plan, drives(), set()) == {"sized": 0, "buffers": 0}
    assert (plan.instances, plan.places) == before


def test_listed_as_before_with_other_fill():
    instances = [Instance("u0", "inv_x1", {"i": "a", "nq": "z"}), *(Instance(f"f{k}", "tie", {}) for k in range(6))]
    placed = [[7, "inv_x1", 0.0, 0.0, "0"], *([None, "tie", 1.0 + SITE * k, 0.0, "0"] for k in range(6))]
    netlist = Netlist("N", (Port("a", "input", 1), Port("z", "output", 1)), tuple(instances))
    rows = free_rows(placed, WIDTHS, FILL, SITE, ROW)
    plan = Plan({"u0": instances[0]}, {"u0": (0.0, 0.0, "0")}, WIDTHS, rows, {}, 0.2, {})
    made, places = plan.listed(netlist, placed, FILL)
    assert places[0] == placed[0] and made.instances[0] == instances[0]
    assert [place[1] for place in places[1:]] == ["tie_w4", "tie", "tie"]
    assert [i.cell for i in made.instances] == [place[1] for place in places]


def test_clock_nets_reach_from_the_port_to_the_registers():
    pins = {"root": {"i": "clk", "q": "tree"}, "gate": {"i": "enable", "clk": "tree", "q": "gated"}}
    cells = [Instance("root", "buf_x4", pins["root"]), Instance("gate", "cg_x1", pins["gate"])]
    cells.append(Instance("r_reg", "dff_x1", {"clk": "gated", "i": "d", "q": "z"}))
    cells.append(Instance("u", "inv_x1", {"i": "d2", "nq": "d"}))
    assert {"clk", "tree", "gated"} <= clock_nets(cells)
    assert not {"d", "d2", "z", "enable"} & clock_nets(cells)


def test_limits_are_read_off_the_tables(tmp_path):
    found = Drives.of(read(liberty(tmp_path / "l.lib")), 1.1)
    assert found.inputs["inv_x1", "i"] == 0.001
    assert found.limits["inv_x1", "nq"] == pytest.approx((1.1 - 0.2) / 10)
    assert found.limits["inv_x4", "nq"] == 0.3  # its max_capacitance
    assert found.stronger("inv_x1", "nq", 0.05) == "inv_x1"
    assert found.stronger("inv_x1", "nq", 0.2) == "inv_x4"
    assert found.stronger("inv_x1", "nq", 0.5) is None
    assert Drives.of(read(tmp_path / "l.lib"), 0.05).limits["inv_x1", "nq"] == 0


def test_length_of_a_net():
    assert length([(1.0, 1.0)]) == 0
    assert length([(0.0, 0.0), (3.0, 4.0)]) == 7
    assert length([(0.0, 0.0), (3.0, 4.0), (1.0, 1.0), (2.0, 2.0), (3.0, 3.0)]) > 7


@pytest.mark.needs("sta")
def test_slacks_are_those_of_the_tables(tmp_path):
    from talbot.flow.layout.design import Clock, Design

    ports = Port("clk", "input", 1), Port("a", "input", 1), Port("z[0]", "output", 1)
    cells = Instance("one[3]", "inv_x1", {"i": "a", "nq": "n"}), Instance("two", "inv_x1", {"i": "n", "nq": "z[0]"})
    netlist = Netlist(
        "Two", (*ports[:2], replace(ports[2], name="z")), tuple(c.with_nets({"z[0]": "z"}) for c in cells)
    )
    design = Design("two", "Two", "", clock=Clock(period_ns=10.0))
    constraints = tmp_path / "two.sdc"
    constraints.write_text(sdc(design))
    library, nets = liberty(tmp_path / "l.lib"), {"n": (100.0, 0.001), "z": (0.0, 0.001)}
    worst = setup_slack(
        netlist, nets, library, constraints, "set_load 0 [all_outputs]\nset_input_transition 0.1 [all_inputs]"
    )
    slower = setup_slack(netlist, nets | {"n": (200.0, 0.001)}, library, constraints, "set_load 0 [all_outputs]")
    assert worst - slower > 0.9  # 100 fF more, 10 ns/pF
    found = setup_slacks(netlist, nets, library, constraints)
    assert set(found) == {("one[3]", "i"), ("one[3]", "nq"), ("two", "i"), ("two", "nq")}
    assert len({round(slack, 3) for slack in found.values()}) == 1  # one path


def test_a_far_sink_has_a_buffer_halfway():
    plan = chain([110.0, 112.0, 390.0, 388.0, 120.0])
    assert shortened(plan, drives(), set()) == 1
    (buffer,) = (name for name in plan.instances if name.endswith(HALFWAY))
    assert 235 < plan.point(buffer)[0] < 265
    assert {name for name, i in plan.instances.items() if i.pins["i"] == plan.instances[buffer].pins["q"]} == {
        "u1",
        "u2",
    }
    assert shortened(plan, drives(), set()) == 0
    check_places(plan)


def test_a_far_sink_of_a_net_that_is_kept_stays():
    plan = chain([10.0, 390.0])
    assert shortened(plan, drives(), {"n"}) == 0


def test_a_sink_far_from_its_port_has_a_buffer_halfway():
    plan = chain([300.0, 310.0])
    assert shortened(plan, drives(), set()) == 1
    assert plan.instances["first"].pins["i"] == "a_east" and 140 < plan.point(f"a_east{HALFWAY}")[0] < 160
    check_places(plan)
