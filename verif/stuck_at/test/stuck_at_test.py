"""The fault simulator against brute force: every fault of small circuits, each built into the netlist."""

import numpy as np
import pytest

from talbot.verif.stuck_at.faults import OUTPUT, collapsed
from talbot.verif.stuck_at.netlist import FF, synthesize
from talbot.verif.stuck_at.simulate import Simulator

pytestmark = pytest.mark.needs("yosys")

COUNTER = """module Top (input clk, input reset, input a, input b, output [2:0] y);
  reg [2:0] n;
  always @(posedge clk) n <= reset ? 0 : n + {a & b, a ^ b};
  assign y = n ^ {3{a & ~b}};
endmodule
"""


@pytest.fixture(scope="module")
def gates():
    return synthesize(COUNTER, "Top")


def by_hand(gates, stimulus, fault):
    """Return the outputs of every cycle with ``fault``, computed gate by gate."""
    functions = {
        "AND": lambda a, b, s: a & b,
        "NAND": lambda a, b, s: 1 - (a & b),
        "OR": lambda a, b, s: a | b,
        "NOR": lambda a, b, s: 1 - (a | b),
        "XOR": lambda a, b, s: a ^ b,
        "XNOR": lambda a, b, s: 1 - (a ^ b),
        "MUX": lambda a, b, s: b if s else a,
        "NOT": lambda a, b, s: 1 - a,
        "BUF": lambda a, b, s: a,
        "FF": lambda a, b, s: a,
    }
    kinds = list(functions)
    values, rows = [0] * gates.nets, []
    values[1] = 1

    def driven(gate):
        pins = [values[net] for net in gates.ins[gate]]
        if fault and fault.gate == gate and fault.pin != OUTPUT:
            pins[fault.pin] = fault.value
        y = functions[kinds[gates.kinds[gate]]](*pins)
        return fault.value if fault and fault.gate == gate and fault.pin == OUTPUT else y

    if fault and fault.pin == OUTPUT and gates.kinds[fault.gate] == FF:
        values[gates.out[fault.gate]] = fault.value
    nets = [net for name, nets in gates.inputs.items() if name != "clk" for net in nets]
    for row in stimulus:
        for net, value in zip(nets, row, strict=True):
            values[net] = int(value)
        for gate in range(gates.gates):
            values[gates.out[gate]] = driven(gate)
        rows.append([values[net] for outputs in gates.outputs.values() for net in outputs])
        data = {gate: driven(gate) for gate in range(gates.gates, len(gates.names))}
        for gate, value in data.items():
            values[gates.out[gate]] = value
    return rows


def test_faults_are_detected_as_by_hand(gates):
    rng = np.random.default_rng(1)
    stimulus = rng.integers(0, 2, (40, 3)).astype(bool)
    places = list(gates.inputs)
    places.remove("clk")
    stimulus[:, places.index("reset")] = np.arange(40) < 2
    faults = collapsed(gates)
    simulator = Simulator(gates, stimulus, settled=2, seed=1)
    simulator.start[gates.out[gates.gates :]] = 0
    good = by_hand(gates, stimulus, None)
    assert simulator.good[2:].tolist() == good[2:]
    wanted = [by_hand(gates, stimulus, fault)[2:] != good[2:] for fault in faults]
    assert np.mean(wanted) > 0.8
    assert simulator.detected(faults).tolist() == wanted


def test_equivalent_faults_are_counted_once():
    """An AND has four: an input at 0 is its output at 0."""
    and_gate = synthesize("module Top (input clk, input a, input b, output y); assign y = a & b; endmodule", "Top")
    assert len(collapsed(and_gate)) == 4
