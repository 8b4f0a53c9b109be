"""Mutants differ from the original; the equivalence check says 'equivalent' of what is, and only of that."""

import shutil
import subprocess

import pytest

from rtl.asp_chip.balance_rtl import Balance
from verif.coverage.program import compile_program
from verif.coverage.test.coverage_test import recorded, recorded_cycles
from verif.mutation.__main__ import main, summary
from verif.mutation.equivalence import DIFFERENT, EQUIVALENT, compare
from verif.mutation.mutants import Mutant, generate, shares, with_mutants
from verif.mutation.score import KILLED, SURVIVED, judge, one_mutant, try_tests

pytestmark = pytest.mark.skipif(not (shutil.which("yosys") and shutil.which("yosys-abc")),
                                reason="needs Yosys: make tools")

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
    from rtl.ports import Port
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


def test_equivalence(small):
    """Against simulation of all short inputs: a mutant that differs there is never called equivalent."""
    ports, mutants, text = small
    program = compile_program(text, "Small", ports, mutant=True)
    said = {m.number: compare(text, "Small", ports, m.number) for m in [Mutant(0, "", "", 0, "", ""), *mutants]}
    assert said[0] == (EQUIVALENT, 0)
    differs = simulated(program, len(mutants))
    for mutant in mutants:
        verdict, cycles = said[mutant.number]
        assert verdict == (DIFFERENT if differs[mutant.number] >= 0 else EQUIVALENT), mutant
        assert (cycles > 0) == (verdict == DIFFERENT)
    assert {DIFFERENT} <= {verdict for verdict, _ in said.values()}


def simulated(program, number, pattern=(0, 1, 1, 1, 0, 1, 1, 0, 1, 1)):
    """First cycle in which each mutant differs from the golden counter."""
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


def planted(trace, folder, of, number):
    """(path of the trace, folder of the mutants, list of Mutant)."""
    path, verilog = trace.save(folder), trace.verilog()
    mutants = generate(verilog, trace.cls, of, number, 1)
    (folder / "mutants.v").write_text(with_mutants(verilog, trace.cls, mutants))
    return str(path), str(folder), mutants


def test_what_tests_do_not_notice_survives(tmp_path):
    """A block without proofs, and one recorded cycle."""
    trace = recorded("Balance", Balance((1, 0, 3, 2), 2, 2, 2, 4), [{"row": 1, "k": 1, "trims": 0x2110}])
    path, folder, mutants = planted(trace, tmp_path, "asp_chip", 8)
    results = [try_tests(path, folder, m.number) for m in mutants]
    assert {KILLED, SURVIVED} <= {r["result"] for r in results}
    results = [judge(path, folder, m.number) if r["result"] == SURVIVED else r for m, r in zip(mutants, results)]
    assert {KILLED, SURVIVED} <= {r["result"] for r in results}
    assert all(r["difference"] > 0 for r in results if r["result"] == SURVIVED)
    assert judge(path, folder, 0)["result"] == EQUIVALENT
    entry = summary(mutants, results)
    count = entry["mutants"]
    assert count["killed"] + count["equivalent"] + count["survived"] == count["made"] == len(mutants)
    assert len(entry["open_points"]) == entry["mutants"]["survived"]
    assert all("rtl/asp_chip/balance_rtl.py" in text for text in entry["open_points"])


def test_what_a_proof_notices_is_killed(tmp_path):
    path, folder, mutants = planted(recorded_cycles(), tmp_path, "edge_adc", 4)
    left = [m for m in mutants if try_tests(path, folder, m.number)["result"] == SURVIVED]
    assert any(judge(path, folder, m.number).get("by", "").startswith("proof ") for m in left[:2])


def test_one_mutant_alone(small, tmp_path):
    _, mutants, text = small
    one = one_mutant(text, "Small", mutants[0].number)
    assert "mutant" not in one.split(";")[0] and one_mutant(text, "Small", 0) != one
    (tmp_path / "one.v").write_text(one)
    subprocess.run(["yosys", "-q", "-p", f"read_verilog {tmp_path}/one.v; hierarchy -check -top Small"], check=True)


def test_arguments(capsys, tmp_path):
    assert main(["--factor", "0", "--out", str(tmp_path)]) == 2
    assert "factor = 0.0" in capsys.readouterr().err
