"""A small design around a macro: clean, matching, proven; a macro that is moved is found."""

import pytest

from talbot.base.steps import Runner, StepError
from talbot.flow.layout.chain import ASSEMBLED
from talbot.flow.layout.design import DESIGNS, Design, MacroPlacement
from talbot.flow.layout.macros import check_same, macro_files
from talbot.flow.layout.options import Options
from talbot.flow.layout.search import lay_out_smallest
from talbot.flow.layout.steps.drc import Drc
from talbot.flow.layout.steps.equivalence import Equivalence, EquivalenceParameters
from talbot.flow.layout.steps.extraction import Extraction, ExtractionBlocks
from talbot.flow.layout.steps.lef import Lef
from talbot.flow.layout.steps.lvs import Lvs
from talbot.flow.layout.steps.parameters import PdkParameters

from . import counter

pytestmark = [pytest.mark.slow, pytest.mark.needs(*counter.NEEDS)]
PAIR = (
    counter.VERILOG
    + """
module Pair(input clk, input reset, input [3:0] step, output reg [8:0] sum);
  wire [7:0] one;
  reg [3:0] last;
  reg [63:0] delay;             // so that there is a design around the blocks
  Counter first(.clk(clk), .reset(reset), .step(last), .count(one), .high());
  always @(posedge clk) begin
    last <= reset ? 4'd0 : step;
    delay <= reset ? 64'd0 : {delay[59:0], last};
    sum <= reset ? 9'd0 : one + {5'd0, delay[63:60]};
  end
endmodule
"""
)
OPTIONS = Options(utilization=0.4, untimed=True)
INNER = Design("counter", "Counter", "")
OUTER = Design("pair", "Pair", "", macros=(MacroPlacement("first", "counter", (0.5, 0.0)),))


def closed(design, verilog, folder, more):
    """The Runner after a layout of ``design`` that keeps the rules."""
    runner = Runner(folder / design.name, counter.files(design, verilog, folder) | more, shared=folder / "shared")
    tried = lay_out_smallest(design, OPTIONS, runner, lambda design, options: [Lef(PdkParameters(options.pdk))])
    assert tried[-1].rules_broken == 0, tried
    return runner


@pytest.fixture(scope="module")
def runners(tmp_path_factory):
    """dict name -> Runner of the counter and of the design around it."""
    folder, patch = tmp_path_factory.mktemp("pair"), pytest.MonkeyPatch()
    patch.setitem(DESIGNS, "counter", INNER)
    made = {"counter": closed(INNER, counter.VERILOG, folder, {})}
    yield made | {"pair": closed(OUTER, PAIR, folder, macro_files(OUTER, made))}
    patch.undo()


def test_it_is_clean_matches_and_is_proven(runners):
    runner = runners["pair"]
    assert runner.run(Drc(PdkParameters()))["metrics"] == {"drc_violations": 0}
    assert runner.run(Lvs(PdkParameters()))["metrics"]["lvs_match"]
    proof = Equivalence(EquivalenceParameters("Pair"))
    proof.inputs = {name: ASSEMBLED.get(source, source) for name, source in proof.inputs.items()}
    assert runner.run(proof)["metrics"] == {
        "equivalence": "proven",
        "registers": 85,
        "constant_registers": 0,
        "double_registers": 0,
        "idle_registers": 0,
    }


def test_the_macro_is_extracted_as_its_cells_and_as_one(runners):
    flat = Extraction(PdkParameters())
    flat.inputs = {name: ASSEMBLED.get(source, source) for name, source in flat.inputs.items()}
    inside = Extraction(PdkParameters())
    whole, outside = (
        runners["pair"].run(step)["metrics"]["wire_pf"] for step in (flat, ExtractionBlocks(flat.parameters))
    )
    part = runners["counter"].run(inside)["metrics"]["wire_pf"]
    assert part < whole and outside < whole
    assert part + outside == pytest.approx(whole, rel=0.05)


def test_a_block_moved_off_its_nets_is_found(runners, tmp_path):
    import klayout.db as db

    layout = db.Layout()
    layout.read(str(runners["pair"].paths["fill.gds"]))
    block = next(i for i in layout.top_cell().each_inst() if i.cell.name == "Counter")
    block.transform(db.DTrans(0, 0.8))
    layout.write(str(tmp_path / "moved.gds"))
    step = Lvs(PdkParameters())
    inputs = {name: runners["pair"].paths[source] for name, source in step.inputs.items()} | {
        "gds": tmp_path / "moved.gds"
    }
    assert not step.run(inputs, {name: tmp_path / file for name, file in step.outputs.items()})["lvs_match"]


def test_another_module_in_the_verilog_is_refused(runners, tmp_path):
    (tmp_path / "Pair.v").write_text(PAIR.replace("8'd99", "8'd98"))
    with pytest.raises(StepError, match="pair: its module Counter differs from that of counter"):
        check_same(OUTER, tmp_path / "Pair.v", runners)
