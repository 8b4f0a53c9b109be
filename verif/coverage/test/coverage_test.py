"""Coverage counts exactly the reached points; wrong plans and exclusions are errors."""

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from talbot.base.tools import ToolError
from talbot.models.parameters import ParameterError
from talbot.rtl.edge_adc import EdgeAdc
from talbot.rtl.harness.ports import Port
from talbot.rtl.harness.testbench import build, hooked
from talbot.rtl.replay.recorder import Recorder
from talbot.rtl.tops import TOPS
from talbot.verif.coverage.constants import constant_bits
from talbot.verif.coverage.measure import Point, Transition, measure, sources_of
from talbot.verif.coverage.ports import Recorded
from talbot.verif.coverage.spi import transfers
from talbot.verif.coverage.testplan import Exclusion, Machine, TestPlan, folder_of, load_plan, plan_file
from talbot.verif.coverage.verdict import judge, matches, ranges
from talbot.verif.verilated.program import compile_program

CYCLES = [(1, 1, 0)] * 3 + [(1, 0, 1)] * 30 + [(0, 0, 1)] * 30  # go, reset, comparator


def recorded(cls, component, cycles):
    """The Trace of ``component``, of class ``cls``, with the inputs of ``cycles``, a dict each."""
    recorder = Recorder(cls)
    with hooked(observe=recorder.observe):
        sim = build(component)
        for inputs in cycles:
            for name, value in inputs.items():
                port = getattr(sim, name)
                port @= value
            sim.sim_tick()
    (trace,) = recorder.traces()
    return trace


def recorded_cycles():
    """The Trace of one EdgeAdc that converts with a comparator that is always high."""
    component = EdgeAdc()
    return recorded(
        "EdgeAdc", component, [{"go": go, "reset": reset, "comparator": comparator} for go, reset, comparator in CYCLES]
    )


@pytest.fixture(scope="module")
def trace():
    return recorded_cycles()


@pytest.fixture(scope="module")
def result(trace, tmp_path_factory):
    path = trace.save(tmp_path_factory.mktemp("coverage"))
    return measure(path, "edge_adc", [(("state", 3),)], ["go_from_idle", "zero_by_the_window"])


def plan(*exclusions):
    return TestPlan(
        "edge_adc",
        ("EdgeAdc",),
        (SimpleNamespace(cover=("go_from_idle", "zero_by_the_window")),),
        (
            Machine(
                (("state", 3),),
                {"idle": 0, "above": 1, "search": 4, "wait": 5},
                (("idle", "search"), ("search", "wait"), ("idle", "above")),
            ),
        ),
        exclusions,
    )


@pytest.mark.parametrize("folder", sorted({folder_of(block) for block in TOPS}))
def test_every_plan_holds(folder):
    assert load_plan(plan_file(folder)).blocks == tuple(block for block in TOPS if folder_of(block) == folder)


def test_what_no_cycle_reaches_is_named(result):
    verdict = judge("EdgeAdc", plan(), [result])
    assert verdict.coverage["functional"] == 50.0 and verdict.coverage["fsm"] == 71.42
    assert "functional edge_adc: zero_by_the_window" in verdict.missing
    assert "fsm state: idle > above" in verdict.missing and "fsm state: above" in verdict.missing
    assert 0 < verdict.coverage["branch"] < 100 and 0 < verdict.coverage["toggle"] < 100
    assert any(
        re.match(r"branch rtl/edge_adc/edge_adc_rtl.py:\d+ EdgeAdc line \d+: if of .if \( magnitude < ", text)
        for text in verdict.missing
    )
    assert any(re.match(r"toggle .*: threshold\[6:0\] 0->1", text) for text in verdict.missing)
    assert not any(re.match(r"toggle .*: go\[", text) for text in verdict.missing)


def test_exclusions(result):
    code = "if ( magnitude < { { 1 { 1'b0 } }, threshold } ) begin"
    good = [
        Exclusion("toggle", ("EdgeAdc.threshold",), "tied"),
        Exclusion("branch", (f"EdgeAdc: {code}",), "dead", "if"),
    ]
    before, after = judge("EdgeAdc", plan(), [result]), judge("EdgeAdc", plan(*good), [result])
    assert after.excluded == 15 and len(after.missing) == len(before.missing) - 3 and not after.errors
    hit = judge("EdgeAdc", plan(Exclusion("toggle", ("EdgeAdc.go",), "wrong")), [result])
    assert any("is hit" in text for text in hit.errors)
    nothing = judge("EdgeAdc", plan(Exclusion("line", ("EdgeAdc: no such line",), "wrong")), [result])
    assert nothing.errors == ["exclude line 'EdgeAdc: no such line': must match a point"]


FIXED = """
typedef struct packed {
  logic [1:0] high;
  logic [0:0] low;
} Pair;

module Part
(
  input logic [0:0] clk ,
  input logic [0:0] reset ,
  input logic [1:0] tied ,
  output Pair pair
);
  logic [0:0] one;
  logic [0:0] late;
  always_ff @(posedge clk) begin
    if ( reset ) begin
      pair <= 3'd2;
      one <= 1'd1;
    end
    else begin
      pair <= ( pair | { 1'd0, tied } ) & 3'd3;
      one <= one | tied[0];
    end
    late <= 1'd1;
  end
endmodule

module Fixed
(
  input logic [0:0] clk ,
  input logic [0:0] reset ,
  input logic [0:0] free ,
  output Pair pair ,
  output Pair other
);
  Part first
  (
    .clk( clk ), .reset( reset ), .tied( {free, 1'd0} ), .pair( pair )
  );
  Part second
  (
    .clk( clk ), .reset( reset ), .tied( 2'd1 ), .pair( other )
  );
endmodule
"""


@pytest.mark.needs("yosys-abc")
def test_constants_are_proven():
    ports = [Port("reset", 1, False), Port("free", 1, False), Port("pair", 3, True), Port("other", 3, True)]
    found = constant_bits(FIXED, "Fixed", ports)
    of_part = {(signal, bit) for module, signal, bit in found if module == "Part"}
    assert of_part == {("pair.high", 0), ("pair.high", 1), ("one", 0), ("late", 0), ("tied", 0)}
    of_top = {(signal, bit) for module, signal, bit in found if module == "Fixed"}
    assert of_top == {("pair.low", 0), *((f"{p}.high", bit) for p in ("pair", "other") for bit in (0, 1))}


def test_a_toggle_is_excluded_by_a_proof_only(tmp_path):
    text = plan_file("adc_bank").read_text()
    for wrong in ("", "    proof: nothing\n"):
        (tmp_path / "adc_bank.testplan.yaml").write_text(text.replace("    proof: adc_bank\n", wrong))
        with pytest.raises(ParameterError, match=r"exclude\[0\].proof = .*: must be a proof of"):
            load_plan(tmp_path / "adc_bank.testplan.yaml")


def test_a_constant_that_toggles_is_an_error(result):
    found = judge("EdgeAdc", plan(), [result], {("EdgeAdc", "go", 0), ("EdgeAdc", "threshold", 6)})
    toggled = {f"EdgeAdc.go:{edge} = toggled: must be constant" for edge in ("0->1", "1->0")}
    assert found.constant == 4 and set(found.errors) == toggled
    still = replace(result, counts=tuple(replace(count, times=0) for count in result.counts))
    assert not judge("EdgeAdc", plan(), [still, result], {("EdgeAdc", "go", 0)}).errors  # of another parameter set


def test_bits_of_an_exclusion():
    bit = Point("toggle", "M", "row[9]:0->1", "", 0, 1, "")
    for at, what, fits in (
        ("M.row[9:7]", "", True),
        ("M.row", "", True),
        ("M.row[9]", "0->1", True),
        ("M.row[8:0]", "", False),
        ("M.row[9]", "1->0", False),
        ("N.row[9]", "", False),
    ):
        assert matches(Exclusion("toggle", (at,), "", what), at, bit) == fits, (at, what)
    assert ranges([9, 3, 7, 8]) == "9:7,3"


def test_a_transition_out_of_the_plan_is_an_error(result):
    wrong = (Transition(0, 0, 4, 1, 7),)
    assert judge("EdgeAdc", plan(), [replace(result, transitions=wrong)]).errors == [
        "fsm state: search > above: no such transition in the plan"
    ]
    in_reset = (Transition(0, 1, 4, 1, 7),)
    assert not judge("EdgeAdc", plan(), [replace(result, transitions=in_reset)]).errors


def test_another_parameter_set_counts(result):
    other = replace(result, functional={"go_from_idle": 0, "zero_by_the_window": 3})
    assert judge("EdgeAdc", plan(), [result, other]).coverage["functional"] == 100.0


def test_verilog_that_does_something_else_is_not_measured(trace, tmp_path):
    fresh, inputs, outputs = trace.lines[10].split()
    lines = list(trace.lines)
    lines[10] = f"{fresh} {inputs} {int(outputs, 16) ^ 1:x}"
    changed = type(trace)(trace.cls, trace.module, trace.arguments, trace.ports, lines, trace.tests)
    with pytest.raises(ToolError, match="cycle 10"):
        measure(changed.save(tmp_path), "edge_adc", [], [])


def test_a_program_is_compiled_once(trace):
    verilog = trace.verilog()
    first = compile_program(verilog, "EdgeAdc", trace.ports, coverage=True)
    before = (first.folder / "replay").stat().st_mtime_ns
    assert compile_program(verilog, "EdgeAdc", trace.ports, coverage=True) == first
    assert (first.folder / "replay").stat().st_mtime_ns == before


def test_lines_have_their_python(trace):
    where = sources_of(trace.verilog())
    lines = trace.verilog().splitlines()
    at = next(i for i, line in enumerate(lines) if "trial <= kept |" in line)
    module, source = where[at + 1]
    assert module == "EdgeAdc" and re.fullmatch(r"rtl/edge_adc/edge_adc_rtl.py:\d+", source)


def test_ports_by_cycle(trace):
    p = Recorded(trace)
    assert p.go[3:6].tolist() == [1, 1, 1] and p.fresh.nonzero()[0].tolist() == [0]
    assert p.was(p.go)[4] == 1 and p.was(p.go)[0] == 0
    assert p.since(p.go == 1)[-1] == 30 and p.since(p.go == 2).max() == -1
    with pytest.raises(AttributeError, match="no port gone"):
        _ = p.gone


def test_transfers_of_pins():
    bits = [1, 0, 0, 0, 0, 0, 0, 1, 1, 1]
    pins = {"csn": [1] * 4, "sclk": [0] * 4, "mosi": [0] * 4}
    for bit in bits:
        pins["csn"] += [0] * 8
        pins["sclk"] += [0] * 4 + [1] * 4
        pins["mosi"] += [bit] * 8
    for name, rest in (("csn", 1), ("sclk", 0), ("mosi", 0)):
        pins[name] += [rest] * 8
    arrays = {name: np.array(values) for name, values in pins.items()}
    p = SimpleNamespace(**arrays, reset=np.zeros(len(pins["csn"]), int), fresh=np.zeros(len(pins["csn"]), bool))
    (found,) = transfers(p)
    assert found.data == b"\x81" and found.bits == 2 and found.half == 4 and found.writes and not found.cut


GOOD = """
blocks: [EdgeAdc]
promises:
  - {promise: it converts, cover: [go_from_idle], tests: [test_every_code]}
"""


@pytest.mark.parametrize(
    "old, new, message",
    [
        ("blocks: [EdgeAdc]", "blocks: [AmpCtrl]", "must be a top in rtl/edge_adc"),
        ("blocks:", "block:", "unknown key"),
        ("cover: [go_from_idle], ", "", r"promises\[0\].cover"),
        ("[go_from_idle]", "[]", r"promises\[0\].cover = \[\]"),
        ("go_from_idle", "no_such_point", "must be in points"),
        ("it", "it", "belong to no promise"),
        ("test_every_code", "test_gone", "no such test"),
        ("tests: [test_every_code]", "tests: []", r"promises\[0\].tests"),
        ("test_every_code", "'verif/faults/test/gone_test.py::test_x'", "no such test"),
        ("tests:", "checks:", "unknown key"),
    ],
)
def test_a_plan_that_does_not_hold_is_refused(tmp_path, old, new, message):
    path = tmp_path / "edge_adc.testplan.yaml"
    path.write_text(GOOD.replace(old, new))
    with pytest.raises(ParameterError, match=message):
        load_plan(path)
