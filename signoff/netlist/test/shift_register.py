"""A library of three cells with round figures and a shift register of them, for tests of timing and power."""

from talbot.signoff.netlist.netlist import Instance, Netlist, Port

AXES = 'index_1 ("0.01, 1.0"); index_2 ("0.001, 1.0");'


def table(kind, values):
    """A 2 x 2 table, rows by slew, columns by load."""
    rows = ", ".join(f'"{a}, {b}"' for a, b in values)
    return f"{kind} (t) {{ {AXES} values ({rows}); }}"


def arc(related, delay, more):
    """Timing of an output: ``delay`` ns unloaded, 1 ns a pF."""
    values = [(delay, delay + 1.0)] * 2
    tables = "".join(
        table(f"cell_{edge}", values) + table(f"{edge}_transition", [(0.05, 0.05)] * 2) for edge in ("rise", "fall")
    )
    return f'timing () {{ related_pin : "{related}"; {more} {tables} }}'


def check(kind, value):
    tables = "".join(
        f'{edge}_constraint (c) {{ values ("{value}, {value}", "{value}, {value}"); }}' for edge in ("rise", "fall")
    )
    return f'timing () {{ related_pin : "clk"; timing_type : {kind}; {tables} }}'


def power(related, rise, fall):
    way = f'related_pin : "{related}";' if related else ""
    return (
        f'internal_power () {{ {way} related_pg_pin : "vdd"; rise_power (t) {{ {AXES} values '
        f'("{rise}, {rise}", "{rise}, {rise}"); }} fall_power (t) {{ {AXES} values ("{fall}, {fall}", '
        f'"{fall}, {fall}"); }} }}'
    )


def cell(name, pins, more=""):
    return (
        f"cell ({name}) {{ area : 1; cell_leakage_power : 5; {more} pg_pin (vdd) {{ pg_type : primary_power; "
        f'voltage_name : "vdd"; }} pg_pin (vss) {{ pg_type : primary_ground; voltage_name : "vss"; }} {pins} }}\n'
    )


def gate(name, output, function, delay):
    sense = "negative" if "!" in function else "positive"
    return cell(
        name,
        f"pin (i) {{ direction : input; capacitance : 0.01; }} pin ({output}) {{ direction : output; "
        f'function : "{function}"; max_capacitance : 1; '
        f"{arc('i', delay, f'timing_sense : {sense}_unate;')}"
        f" {power('i', 0.2, 0.4)} }}",
    )


def liberty(setup=0.2, hold=0.1):
    """Text of the Liberty: inv_x1 (0.1 ns), buf_x1 (0.3 ns), dff_x1 (0.5 ns; setup, hold in ns)."""
    percent = "".join(
        f"{side}put_threshold_pct_{edge} : 50; slew_{what}_threshold_pct_{edge} : {value};\n"
        for edge in ("rise", "fall")
        for side, what, value in (("in", "lower", 20), ("out", "upper", 80))
    )
    return (
        f"""library (small) {{ delay_model : table_lookup; time_unit : "1ns"; voltage_unit : "1V";
current_unit : "1mA"; leakage_power_unit : "1nW"; pulling_resistance_unit : "1kohm"; capacitive_load_unit (1, "pf");
nom_process : 1; nom_temperature : 25; nom_voltage : 2; {percent} voltage_map ("vdd", 2); voltage_map ("vss", 0);
operating_conditions (typical) {{ process : 1; temperature : 25; voltage : 2; tree_type : balanced_tree; }}
lu_table_template (t) {{ variable_1 : input_net_transition; variable_2 : total_output_net_capacitance; {AXES} }}
power_lut_template (t) {{ variable_1 : input_transition_time; variable_2 : total_output_net_capacitance; {AXES} }}
lu_table_template (c) {{ variable_1 : related_pin_transition; variable_2 : constrained_pin_transition;
index_1 ("0.01, 1.0"); index_2 ("0.01, 1.0"); }}
"""
        + gate("inv_x1", "nq", "!i", 0.1)
        + gate("buf_x1", "q", "i", 0.3)
        + cell(
            "dff_x1",
            f"pin (i) {{ direction : input; capacitance : 0.02; {check('setup_rising', setup)} "
            f"{check('hold_rising', hold)} }} pin (clk) {{ direction : input; clock : true; "
            f"capacitance : 0.02; {power('', 0.5, 1.5)} }} pin (q) {{ direction : output; "
            f'function : "IQ"; max_capacitance : 1; {arc("clk", 0.5, "timing_type : rising_edge;")} '
            f"{power('clk', 2.0, 4.0)} }}",
            'ff (IQ, IQN) { clocked_on : "clk"; next_state : "i"; }',
        )
        + "}\n"
    )


CELLS = """
module inv_x1 (i, nq);
  input i;
  output nq;
  assign nq = ~i;
endmodule
module buf_x1 (i, q);
  input i;
  output q;
  assign q = i;
endmodule
module dff_x1 (i, clk, q);
  input i, clk;
  output q;
  reg state;
  assign q = state;
  always @(posedge clk) state <= i;
endmodule
"""


def shift(between=1):
    """a -> register -> ``between`` inverters -> register -> y, and n = not a straight through."""
    instances = [Instance("first.d_reg", "dff_x1", {"i": "a", "clk": "clk", "q": "w0"})]
    instances += [Instance(f"u{k}", "inv_x1", {"i": f"w{k}", "nq": f"w{k + 1}"}) for k in range(between)]
    instances += [
        Instance("second.d_reg", "dff_x1", {"i": f"w{between}", "clk": "clk", "q": "y"}),
        Instance("u_n", "inv_x1", {"i": "a", "nq": "n"}),
    ]
    return Netlist(
        "Shift",
        (Port("clk", "input", 1), Port("a", "input", 1), Port("y", "output", 1), Port("n", "output", 1)),
        tuple(instances),
    )


HEAD = {
    "ports": [
        {"path": "a", "width": 1, "output": False},
        {"path": "n", "width": 1, "output": True},
        {"path": "y", "width": 1, "output": True},
    ]
}


def trace(cycles, inverted):
    """Lines of a trace of random bits through ``shift``."""
    import random

    bits, lines, state = random.Random(1), [], (0, 0)
    for cycle in range(cycles):
        a = bits.getrandbits(1)
        first, second = state
        lines.append(f"{int(cycle < 2)} {a:x} {(1 - a) | second << 1:x}")
        state = a, first ^ inverted
    return lines
