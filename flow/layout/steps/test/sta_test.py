"""Two flip-flops in a row: a hold time that the way between them does not reach, and a setup time, are found."""

import pytest

from talbot.flow.layout.design import Clock, Design, IoConstraints
from talbot.flow.layout.report.metrics import RULES, broken
from talbot.flow.layout.steps.sta import Sta, StaParameters
from talbot.flow.layout.timing.constraints import sdc
from talbot.platforms.wires import CORNERS
from talbot.signoff.netlist.netlist import Instance, Netlist, Port
from talbot.signoff.parasitics.spef import Tree, spef

pytestmark = pytest.mark.needs("openroad")

NETLIST = Netlist(
    "Pair",
    (Port("clk", "input", 1), Port("a", "input", 1), Port("z", "output", 1)),
    (
        Instance("first_reg", "dff_x1", {"clk": "clk", "i": "a", "q": "between"}),
        Instance("second_reg", "dff_x1", {"clk": "clk", "i": "between", "q": "z"}),
    ),
)


def liberty(setup, hold, limits=""):
    """A flip-flop that takes 0.3 ns; setup, hold: ns. limits: attributes of its output."""

    def times(kind, ns):
        return (
            f'timing() {{ related_pin : "clk"; timing_type : {kind}_rising; '
            f'rise_constraint(scalar) {{ values("{ns}"); }} fall_constraint(scalar) {{ values("{ns}"); }} }}'
        )

    tables = " ".join(
        f'{name}(scalar) {{ values("{value}"); }}'
        for name, value in (("cell_rise", 0.3), ("cell_fall", 0.3), ("rise_transition", 0.1), ("fall_transition", 0.1))
    )
    percent = "".join(
        f"{name}_threshold_pct_{edge} : {value}; "
        for edge in ("rise", "fall")
        for name, value in (("input", 50), ("output", 50), ("slew_lower", 20), ("slew_upper", 80))
    )
    return f"""library(one) {{ {percent}
  delay_model : table_lookup; time_unit : "1ns"; capacitive_load_unit(1, pf); voltage_unit : "1V"; current_unit : "1mA";
  leakage_power_unit : "1nW"; nom_voltage : 1.8; nom_temperature : 25; nom_process : 1;
  cell(dff_x1) {{ area : 1; ff(IQ,IQN) {{ clocked_on : "clk"; next_state : "i"; }}
    pin(clk) {{ direction : input; clock : true; capacitance : 0.001; }}
    pin(i) {{ direction : input; capacitance : 0.001; {times("setup", setup)} {times("hold", hold)} }}
    pin(q) {{ direction : output; function : "IQ"; {limits}
      timing() {{ related_pin : "clk"; timing_type : rising_edge; {tables} }} }} }} }}
"""


WIRE = 2.0, 10.0  # fF, ohm
HELD = IoConstraints()


def timed(folder, setup=0.1, hold=0.05, wire=WIRE, derate=0.0, io=HELD, limits="", **wires):
    """Metrics of the STA, and the rules of the layout that its slacks break. wires: others, by corner."""
    design = Design("pair", "Pair", "", clock=Clock(period_ns=10.0, derate=derate), io=io)
    files = {
        "verilog": NETLIST.verilog(),
        "spef": spef(NETLIST, {"between": wire}),
        "sdc": sdc(design),
        "liberty": liberty(setup, hold, limits),
    } | {corner: spef(NETLIST, {"between": wires.get(corner, wire)}) for corner in CORNERS}
    for name, text in files.items():
        (folder / name).write_text(text)
    step = Sta(StaParameters("Pair", "one", 10.0))
    found = step.run({name: folder / name for name in files}, {n: folder / file for n, file in step.outputs.items()})
    summary = {name: {"one": found[name]} for name in ("wns_ns", "whs_ns")}
    return found, [line.split(" = ")[0] for line in broken(summary, {name: RULES[name] for name in summary})]


def test_what_keeps_its_times_breaks_no_rule(tmp_path):
    found, rules = timed(tmp_path)
    assert found["whs_ns"] == pytest.approx(0.3 - 0.05 - 0.05, abs=0.01)  # delay, hold, uncertainty
    assert rules == []
    files = {path.name for path in tmp_path.iterdir() if path.suffix != ".log"}
    assert files == {"verilog", "spef", "sdc", "liberty", *CORNERS, *Sta.outputs.values()}


def test_an_input_that_changes_with_the_edge_breaks_hold(tmp_path):
    found, rules = timed(tmp_path, io=IoConstraints(input_hold_ns=0.0))
    assert found["whs_ns"] == pytest.approx(0.0 - 0.05 - 0.05, abs=0.01) and rules == ["whs_ns"]


def test_hold_counts_at_every_corner_of_the_wires(tmp_path):
    slow = Tree(
        1000.0,
        {("first_reg", "q"): 0.0, ("second_reg", "i"): 1000.0},
        [(("first_reg", "q"), ("second_reg", "i"), 100.0)],
    )
    found, _ = timed(tmp_path, wire=slow, min=WIRE)
    by_wires = found["hold_by_wires_ns"]
    assert by_wires["typ"] == by_wires["max"] > by_wires["min"] + 0.02 and found["whs_ns"] == by_wires["min"]


def test_on_chip_variation_takes_from_both_slacks(tmp_path):
    """A delay of 0.3 ns."""
    plain, derated = timed(tmp_path)[0], timed(tmp_path, derate=0.1)[0]
    assert plain["wns_ns"] - derated["wns_ns"] == pytest.approx(0.03, abs=0.001)
    assert plain["whs_ns"] - derated["whs_ns"] == pytest.approx(0.03, abs=0.001)


def test_pins_beyond_a_limit_are_counted(tmp_path):
    found, _ = timed(tmp_path, limits="max_transition : 0.05; max_capacitance : 0.0001;")
    assert found["slew_violations"] >= 2 and found["capacitance_violations"] == 2  # of both outputs
    found, _ = timed(tmp_path, limits="max_transition : 0.5; max_capacitance : 1.0;")
    assert (found["slew_violations"], found["capacitance_violations"]) == (0, 0)


@pytest.mark.parametrize("times, rule", [({"hold": 0.5}, "whs_ns"), ({"setup": 9.9}, "wns_ns")])
def test_a_time_that_is_not_kept_is_found(tmp_path, times, rule):
    assert timed(tmp_path, **times)[1] == [rule]


def test_a_tree_of_resistors_delays_by_elmore(tmp_path):
    """1 pF behind 100 ohm and 1 kohm: the delay is less than Elmore's, and not far from 0.69 of it."""
    first, second = ("first_reg", "q"), ("second_reg", "i")
    nodes = {first: 0.0, 1: 0.0, 2: 1000.0, second: 0.0}
    tree = Tree(1000.0, nodes, [(first, 1, 100.0), (1, 2, 1000.0), (1, second, 5.0)])
    plain, _ = timed(tmp_path)
    branched, _ = timed(tmp_path, wire=tree)
    one = timed(tmp_path, wire=Tree(1000.0, nodes, [(first, 1, 100.0), (1, 2, 1.0), (2, second, 1000.0)]))[0]
    assert 0.02 < branched["whs_ns"] - plain["whs_ns"] <= 0.11
    assert one["whs_ns"] - plain["whs_ns"] <= 0.12
