"""Mutants differ from the original; the equivalence check reports 'equivalent' for equivalent mutants only."""

import pytest

from talbot.base.command import main
from talbot.base.paths import PACKAGE
from talbot.base.tools import run
from talbot.models.parameters import SensorParameters
from talbot.rtl.asp_chip.balance_rtl import Balance
from talbot.rtl.harness.ports import Port, ports_of
from talbot.rtl.harness.translate import translate_component
from talbot.rtl.tops import build_top
from talbot.verif.coverage.test.coverage_test import recorded, recorded_cycles
from talbot.verif.coverage.testplan import folder_of
from talbot.verif.mutation import command
from talbot.verif.mutation.command import summary
from talbot.verif.mutation.equivalence import DIFFERENT, ENGINES, EQUIVALENT, compare, promises
from talbot.verif.mutation.judge import SURVIVED, judge, mutated, one_mutant, own_tests
from talbot.verif.mutation.mutants import Mutant, generate, shares, with_mutants
from talbot.verif.mutation.trial import attempt
from talbot.verif.verilated.program import compile_program

pytestmark = pytest.mark.needs("yosys", "yosys-abc")

# A counter whose upper bit is never looked at, and a register that no output shows
SMALL = """
// At rtl/small/small_rtl.py
module Small(input clk, input [0:0] reset, input [0:0] up, output [1:0] count);
  logic [1:0] n;
  logic [1:0] hidden;
  // At rtl/small/small_rtl.py:7
  always_ff @(posedge clk) begin
    if ( reset ) begin n <= 2'd0; hidden <= 2'd0; end
    else begin hidden <= n; n <= up ? n + 2'd1 : n; end
  end
  assign count = n;
endmodule
"""


@pytest.fixture(scope="module")
def small():
    ports = (Port("reset", 1, False), Port("up", 1, False), Port("count", 2, True))
    mutants = generate(SMALL, "Small", "small", 12, 3)
    return ports, mutants, with_mutants(SMALL, "Small", mutants)


def test_the_sample_is_seeded_and_spread(small):
    _, mutants, _ = small
    assert mutants == generate(SMALL, "Small", "small", 12, 3) != generate(SMALL, "Small", "small", 12, 4)
    assert [m.number for m in mutants] == list(range(1, len(mutants) + 1)) and 4 <= len(mutants) <= 12
    assert {m.module for m in mutants} == {"Small"} and all(m.source.startswith("rtl/small/") for m in mutants)
    parts = shares({"A": 400, "B": 25, "C": 0}, 50)
    assert parts == {"A": 40, "B": 10}


@pytest.mark.slow
def test_equivalence(small):
    """Against simulation of all short inputs: a mutant that differs there is never called equivalent."""
    ports, every, text = small
    mutants = every[::2]
    program = compile_program(text, "Small", ports, mutant=True)
    verdicts = {m.number: compare(text, "Small", ports, m.number) for m in [ORIGINAL, *mutants]}
    assert verdicts[0] == (EQUIVALENT, 0)
    differs = simulated(program, len(every))
    for mutant in mutants:
        verdict, cycles = verdicts[mutant.number]
        assert verdict == (DIFFERENT if differs[mutant.number] >= 0 else EQUIVALENT), mutant
        assert (cycles > 0) == (verdict == DIFFERENT)
    assert {DIFFERENT} <= {verdict for verdict, _ in verdicts.values()}


def simulated(program, number, pattern=(0, 1, 1, 1, 0, 1, 1, 0, 1, 1)):
    """Return the first cycle in which each mutant differs from the golden counter."""
    lines, n = ["1 1 0", "0 1 0"], 0
    for up in pattern * 3:
        lines.append(f"0 {up << 1:x} {n:x}")
        n = n + up & 3
    lines += [f"0 1 {n:x}", "0 0 0", "0 0 0"]
    trace = program.folder / "counter.trace"
    trace.write_text("\n".join(lines) + "\n")
    found = program.run(trace, "--mutants", "0", str(number))
    assert found.pop(0) == -1
    return found


ORIGINAL = Mutant(0, "", "Balance", 0, "", "")


def one_cycle():
    return recorded("Balance", Balance((1, 0, 3, 2), 2, 2, 2, 4), [{"row": 1, "k": 1, "trims": 0x2110}])


def planted(trace, folder, of, number):
    """(path of the trace, folder of the mutants, list of Mutant)."""
    path, verilog = trace.save(folder), trace.verilog()
    mutants = generate(verilog, trace.cls, of, number, 1)
    (folder / "mutants.v").write_text(with_mutants(verilog, trace.cls, mutants))
    return str(path), str(folder), mutants


BLIND = """
from talbot.models.parameters import SensorParameters
from talbot.rtl.asp_chip.balance_rtl import Balance
from talbot.rtl.harness.translate import translate_component
from talbot.rtl.harness.ports import Port, ports_of
from talbot.rtl.tops import build_top
from talbot.rtl.harness.testbench import build

def test_looks_at_nothing():
    sim = build(Balance((1, 0, 3, 2), 2, 2, 2, 4))
    sim.row @= 1
    sim.trims @= 0x2110
    sim.sim_tick()
"""


@pytest.mark.slow
def test_what_no_test_checks_survives(tmp_path):
    """A mutant that changes an unchecked pin is not killed by that test; the module's tests kill it."""
    path, folder, mutants = planted(one_cycle(), tmp_path, "asp_chip", 8)
    blind, seeing = tmp_path / "blind_test.py", tmp_path / "seeing_test.py"
    blind.write_text(BLIND)
    seeing.write_text(BLIND.replace("nothing", "the_trim") + "    assert sim.balance == 2\n")
    head, verilog = mutated(path, folder)
    assert not attempt(head, verilog, None, [seeing], 1000).failed
    failed = [m for m in mutants if attempt(head, verilog, m, [seeing], 1000).failed]
    assert len(failed) > 0 and all(compare(verilog, "Balance", head.ports, m.number)[0] == DIFFERENT for m in failed)
    for mutant in failed:
        trial = attempt(head, verilog, mutant, [blind], 1000)
        assert trial.took_place and not trial.failed


def test_judged(tmp_path):
    path, folder, mutants = planted(one_cycle(), tmp_path, "asp_chip", 4)
    results = [judge(path, folder, mutant) for mutant in mutants]
    assert {SURVIVED} <= {r.result for r in results} <= {SURVIVED, EQUIVALENT}
    assert all(r.difference > 0 for r in results if r.result == SURVIVED)
    assert judge(path, folder, ORIGINAL).result == EQUIVALENT
    entry = summary(mutants, results)
    count = entry.mutants
    assert count.killed + count.equivalent + count.survived == count.made == len(mutants)
    assert len(entry.open_points) == count.survived
    assert all("rtl/asp_chip/balance_rtl.py" in text for text in entry.open_points)


def test_a_module_has_tests_of_its_own(tmp_path):
    balance = Mutant(1, "", "Balance", 0, "rtl/asp_chip/balance_rtl.py:31", "")
    assert own_tests(balance) == [PACKAGE / "rtl" / "asp_chip" / "test" / "balance_test.py"]
    assert not own_tests(Mutant(1, "", "AmpCtrl", 0, "rtl/amp_ctrl/amp_ctrl_rtl.py", ""))


def test_what_a_proof_notices_is_killed(tmp_path):
    path, folder, mutants = planted(recorded_cycles(), tmp_path, "edge_adc", 4)
    assert any(judge(path, folder, m).by.startswith("proof ") for m in mutants[:2])


def test_one_mutant_alone(small, tmp_path):
    _, mutants, text = small
    one = one_mutant(text, "Small", mutants[0].number)
    assert "mutant" not in one.split(";")[0] and one_mutant(text, "Small", 0) != one
    (tmp_path / "one.v").write_text(one)
    run(["yosys", "-q", "-p", f"read_verilog {tmp_path}/one.v; hierarchy -check -top Small"])


@pytest.mark.slow
@pytest.mark.parametrize("block", ["PhasePath", "ReadoutSeq", "RunLength"])
def test_promises_leave_the_block_its_work(block):
    """A promise that no neighbour can keep would make all mutants equivalent."""
    top = build_top(block, SensorParameters())
    text = translate_component(top, block)
    mutants = generate(text, block, folder_of(block), 8, 1)
    assert promises(block)
    planted = with_mutants(text, block, mutants)
    assert any(compare(planted, block, ports_of(top), m.number, ENGINES[1:2])[0] == DIFFERENT for m in mutants)


def test_arguments(capsys, tmp_path):
    assert main(command, ["--factor", "0", "--out", str(tmp_path)]) == 2
    assert "factor = 0.0" in capsys.readouterr().err
