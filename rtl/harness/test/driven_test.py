"""The levels of Verilog equal PyMTL in every cycle, in a harness too; an X after the reset fails."""

import pytest
from pymtl3 import Component, InPort, OutPort, connect, update, update_ff

from talbot.base.tools import ToolError
from talbot.rtl.harness import icarus
from talbot.rtl.harness.driven import SimulationError
from talbot.rtl.harness.icarus import kept_program
from talbot.rtl.harness.netlists import Netlists, netlist
from talbot.rtl.harness.ports import Port
from talbot.rtl.harness.testbench import build, hooked
from talbot.rtl.harness.verilated import kept_library

pytestmark = pytest.mark.needs("iverilog")
LEVELS = False, True, "icarus"


class Counter(Component):
    """Counts `step`; `carry` is high in the same cycle if the next count is 0."""

    def construct(s):
        s.step, s.value, s.carry = InPort(4), OutPort(4), OutPort()

        @update
        def up_carry():
            s.carry @= s.value + s.step == 0

        @update_ff
        def up_value():
            if s.reset:
                s.value <<= 0
            else:
                s.value <<= s.value + s.step


class WithoutReset(Component):
    """A register without a reset."""

    def construct(s):
        s.step, s.value = InPort(4), OutPort(4)

        @update_ff
        def up_value():
            if s.step == 3:
                s.value <<= s.step


class Harness(Component):
    """A harness whose counter's step depends on an input and on its own count."""

    def construct(s, dut):
        s.step, s.value = InPort(4), OutPort(4)
        s.dut = dut
        connect(s.value, s.dut.value)

        @update
        def up_step():
            s.dut.step @= s.step ^ 1 if s.value == 5 else s.step


def seen(sim, steps):
    """The value, and carry or 0, ahead of every clock edge."""
    out = []
    for step in steps:
        sim.step @= step
        sim.sim_eval_combinational()
        out.append((int(sim.value), int(getattr(sim, "carry", 0))))
        sim.sim_tick()
    return out


STEPS = [1, 1, 3, 0, 1, 15, 0, 2, 15, 15, 1, 7, 9, 5] * 4


def test_equals_pymtl_in_every_cycle():
    runs = [seen(build(Counter(), level), STEPS) for level in LEVELS]
    assert runs[0] == runs[1] == runs[2] and any(carry for _, carry in runs[0])


def test_in_a_harness():
    runs = [seen(build(Harness(Counter()), level), STEPS) for level in LEVELS]
    assert runs[0] == runs[1] == runs[2] and any(value == 5 for value, _ in runs[0])


@pytest.mark.parametrize("level", LEVELS)
def test_an_output_follows_an_input_within_the_cycle(level):
    sim = build(Counter(), level)
    for step, carry in ((0, 1), (1, 0), (0, 1)):
        sim.step @= step
        sim.sim_eval_combinational()
        assert int(sim.carry) == carry and int(sim.value) == 0


def test_x_must_not_leave_reset():
    with pytest.raises(AssertionError, match="cycle 1: value = xxxx"):
        build(WithoutReset(), "icarus")


def test_a_simulation_that_ends_early_is_an_error(tmp_path):
    path = tmp_path / "Counter.v"
    path.write_text(
        "module Counter(input clk, reset, input [3:0] step, output [3:0] value, output carry);\n"
        "  assign value = 0, carry = 0;\n  initial #150 $finish;\nendmodule\n"
    )
    netlists = Netlists({"Counter": netlist(f"Counter={path}")})
    with pytest.raises(SimulationError, match="ended early"), hooked(substitute=netlists.substitute):
        seen(build(Counter(), "icarus"), STEPS)


def test_a_warning_of_verilator_is_an_error():
    text = "module Latch(input clk, input a, output reg b);\n  always @* if (a) b = 1;\nendmodule\n"
    with pytest.raises(ToolError, match="LATCH"):
        kept_library("Latch", "Latch", (Port("a", 1, False), Port("b", 1, True)), text)


def test_a_kept_program_that_is_damaged_is_compiled_again(monkeypatch, tmp_path):
    monkeypatch.setattr(icarus, "PROGRAMS", tmp_path)
    program = kept_program("Empty", [], "Empty", ["module Empty; endmodule\n"])
    whole = program.stat().st_size
    for damage in (lambda: program.write_bytes(program.read_bytes()[:99]), program.unlink):
        damage()
        assert kept_program("Empty", [], "Empty", ["module Empty; endmodule\n"]).stat().st_size == whole
