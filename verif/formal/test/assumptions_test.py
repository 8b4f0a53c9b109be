"""Over-constrained copies of proofs: assumptions added, strengthened and hidden. Each is rejected."""

import dataclasses

import pytest

from talbot.models.parameters import ParameterError
from talbot.verif.formal import command, design, manifest
from talbot.verif.formal.engine import FormalError
from talbot.verif.formal.freedom import FreedomResult, freedom
from talbot.verif.formal.necessity import NecessityResult, conjuncts, necessity
from talbot.verif.formal.plan import pieces
from talbot.verif.formal.proof import labels
from talbot.verif.formal.prove import CoverResult

pytestmark = pytest.mark.needs("yosys-smtbmc", "boolector")


PUT = "a_put: assume (!put || ready);"


def problems(name, folder, *changes, checks=(necessity, freedom), label="", **listed):
    """Return the problems of proof ``name`` after ``changes`` (find, replace) of its wrapper, by ``checks``.

    label: of the assumptions whose necessity is looked at, by default all.
    """
    proof = next(proof for proof in manifest.every() if proof.name == name)
    text = proof.wrapper.read_text()
    for find, replace in changes:
        assert text.count(find) == 1, find
        text = text.replace(find, replace)
    path = folder / proof.wrapper.name
    path.write_text(text)
    proof = dataclasses.replace(proof, wrapper=path, assumptions=proof.assumptions | listed)
    arguments = proof, design.exported(proof), design.wrapper(proof)
    needs = necessity(*arguments, label) if necessity in checks else NecessityResult()
    free = next((check(*arguments) for check in checks if check is not necessity), FreedomResult())
    return command.Outcome(proof, {}, CoverResult([], [], 0.0), {}, needs, free).problems


def test_the_assumptions_of_the_byte_queue_are_needed_and_leave_its_inputs_free(tmp_path):
    assert problems("byte_queue", tmp_path) == []


def cases(fast, *rows):
    """Parameters of a test, each a name and its values; those whose name is not in ``fast`` are slow."""
    return [pytest.param(*row, id=name, marks=() if name in fast else pytest.mark.slow) for name, *row in rows]


@pytest.mark.parametrize(
    "statement, needless",
    cases(
        ("added", "two cycles", "in a source"),
        ("added", "a_x: assume (octet < 64);", "a_x: "),
        ("never reset again", "a_x: assume (first || !reset);", "a_x: "),
        ("three", "a_x: assume (first || octet < 2 && send__rdy && !reset);", "a_x: send__rdy"),
        ("if", "if (send__rdy) a_x: assume (octet != 3);", "a_x: "),
        ("implication", "a_x: assume (!watch || octet[7]);", "a_x: "),
        ("two cycles", "a_x: assume (first || !was_rdy || octet != was_msg);", "a_x: "),
        ("initial", "initial a_x: assume (octet == 0);", "a_x: "),
        ("choice", "a_x: assume (put ? octet < 64 : 1);", "a_x: "),
        ("in a source", "Narrow narrow (.octet(octet));", "narrow.a_x: "),
    ),
)
def test_an_added_assumption_is_needless_whatever_its_reason(tmp_path, statement, needless):
    narrow = "endmodule\nmodule Narrow (input [7:0] octet);\n  always @* a_x: assume (octet < 64);\nendmodule\n"
    text = ("always @* begin\n    if (first) a_reset", f"{statement}\n  always @* begin\n    if (first) a_reset")
    if statement.startswith("Narrow"):
        changes = [
            text,
            (
                "c_through: cover (take && put && following);\n  end\nendmodule",
                f"c_through: cover (take && put && following);\n  end\n{narrow}",
            ),
        ]
    elif statement.startswith("initial"):
        changes = [text]
    else:
        changes = [(PUT, f"{PUT} {statement}")]
    found = problems("byte_queue", tmp_path, *changes, checks=[necessity], label="a_x", a_x="p_octet of another block")
    assert any(f"byte_queue.{needless}" in line and "= needless" in line for line in found), found


@pytest.mark.parametrize(
    "stronger, needless",
    cases(
        ("conjunct inside",),
        ("conjunct inside", "a_put: assume (!put || ready && octet[0]);", "a_put: octet[0]"),
        ("conjunct", "a_put: assume ((!put || ready) && send__rdy);", "a_put: send__rdy"),
        ("condition", "a_put: assume (!(put || octet == 9) || ready);", "a_put: octet == 9"),
        ("if", "if (put || watch) a_put: assume (ready);", "a_put: watch"),
    ),
)
def test_an_assumption_that_became_stronger_has_a_needless_part(tmp_path, stronger, needless):
    found = problems("byte_queue", tmp_path, (PUT, stronger), checks=[necessity], label="a_put")
    assert any(line.startswith(f"RunLength.byte_queue.{needless} = needless") for line in found), found


@pytest.mark.parametrize(
    "changes, missing",
    cases(
        ("a bit", "tied"),
        ("stronger", [(PUT, "a_put: assume (!put);")], "put=1"),
        (
            "a bit",
            [
                ("input [7:0] octet,", "input [7:0] wide,"),
                ("  wire ready", "  wire [7:0] octet = wide & 8'h7F;\n  wire ready"),
            ],
            "octet=255",
        ),
        (
            "constant",
            [("input [7:0] octet,", ""), ("  wire ready", "  (* anyconst *) wire [7:0] octet;\n  wire ready")],
            "octet changes",
        ),
        (
            "reset",
            [
                ("input reset,", "input pin,"),
                ("  wire ready", "  wire reset = pin && first;\n  wire ready"),
                ("first = 1, ", ""),
                ("reg [1:0] inside", "reg first = 1;\n  reg [1:0] inside"),
            ],
            "reset=1",
        ),
        (
            "tied",
            [("input send__rdy, ", ""), ("  wire ready", "  wire send__rdy = 1;\n  wire ready")],
            "tied = send__rdy",
        ),
    ),
)
def test_an_input_that_is_not_free_is_found(tmp_path, changes, missing):
    found = problems("byte_queue", tmp_path, *changes, checks=[freedom])
    assert any(f": {missing}" in line for line in found), found


@pytest.mark.slow
@pytest.mark.parametrize(
    "name, find, added, part",
    [
        ("edge_adc", "a_config: assume", "a_x: assume (threshold < 64);", "a_x: "),
        ("reg_file_384x384_8", "if (first) a_reset", "a_x: assume (first || !reset);", "a_x: "),
        ("stream_9x13_2", "if (first) a_reset", "a_x: assume (first || decimation < 2 && !reset);", "a_x: "),
    ],
)
def test_the_over_constraints_that_were_not_seen(tmp_path, name, find, added, part):
    found = problems(name, tmp_path, (find, f"{added}\n    {find}"), checks=[necessity], a_x="a reason")
    assert any(f".{part}" in line for line in found)


def listed(name, wrapper):
    """The conjuncts of the assumptions of proof ``name`` with another wrapper file."""
    proof = next(proof for proof in manifest.every() if proof.name == name)
    proof = dataclasses.replace(proof, wrapper=wrapper)
    return proof, conjuncts(proof, design.exported(proof), design.wrapper(proof)).names


@pytest.mark.slow
@pytest.mark.parametrize(
    "first, other, find, added",
    [
        ("phase_path", "phase_path_radix2", "a_constant: assume (", "(`LANES != 1 || noise_floor < 128) && "),
        ("adc_bank_one_lane", "adc_bank_two_lanes", "a_config: assume (", "(`LANES != 2 || step__msg[3:0] != 9) && "),
    ],
)
def test_an_over_constraint_at_another_size_is_found(tmp_path, first, other, find, added):
    proof = next(proof for proof in manifest.every() if proof.name == first)
    text, path = proof.wrapper.read_text(), tmp_path / "wrapper.sv"
    path.write_text(text)
    (_, before), (_, whole) = listed(first, path), listed(other, path)
    assert command.more(whole, before) == []
    assert text.count(find) == 1
    path.write_text(text.replace(find, find + added))
    (_, before), (proof, whole) = listed(first, path), listed(other, path)
    odd = command.more(whole, before)
    assert odd
    outcome = command.Outcome(proof, {}, CoverResult([], [], 0.0), {}, only_here=odd)
    assert f"{proof.name}.{odd[0]} = at this size alone: must be at the first" in outcome.problems[0]


@pytest.mark.slow
@pytest.mark.parametrize(
    "name, find, narrowed",
    [
        ("phase_path_radix2", "wire recv__rdy, send__val;", "wire [7:0] noise_floor = `LANES == 1 ? 0 : any_floor;"),
        ("adc_bank_two_lanes", "localparam FRAME", "wire [6:0] threshold = `LANES == 2 ? 0 : any_floor;"),
    ],
)
def test_a_constant_input_at_another_size_is_found(tmp_path, name, find, narrowed):
    wide = narrowed.split()[1]
    signal = narrowed.split()[2]
    changes = [(f"input {wide} {signal}", f"input {wide} any_floor"), (find, f"{narrowed}\n  {find}")]
    found = problems(name, tmp_path, *changes, checks=[each_input])
    assert any(f": tied = {signal}" in line or f": {signal}" in line for line in found), found
    assert problems(name, tmp_path, checks=[each_input]) == []


def each_input(*arguments):
    """The check of the inputs at a size that is not the first."""
    return freedom(*arguments, pairs=False)


@pytest.mark.parametrize("name", ["balance_1x1", pytest.param("balance_4x1", marks=pytest.mark.slow)])
def test_an_input_that_is_not_free_at_another_size_is_found(tmp_path, name):
    """The first size, 1 x 6, allows all values of the narrowed input."""
    wires = "input [2:0] k,", "  wire [9:0] balance;"
    changes = [
        ("input [9:0] row,", "input [9:0] any_row,"),
        (wires[1], f"  wire [9:0] row = `TILE_COLS == 1 ? {{1'b0, any_row[8:0]}} : any_row;\n{wires[1]}"),
    ]
    found = problems(name, tmp_path, *changes, checks=[freedom])
    assert any(": row=1023 = not reached" in line for line in found), found
    assert problems("balance_1x6", tmp_path, *changes, checks=[freedom]) == []
    assert any(piece.name == "freedom" for piece in pieces(sized(name), ["boolector"], False))


def sized(name):
    """The proof ``name``."""
    return next(proof for proof in manifest.every() if proof.name == name)


@pytest.mark.parametrize(
    "text",
    [
        "assume (octet < 64);",
        "a_x: assume property (octet < 64);",
        "a_x: restrict (octet < 64);",
        "`define MUST(x) assume (x)\n`MUST(octet < 64)",
        "/* a_x: */ assume (octet < 64);",
    ],
)
def test_an_assumption_without_a_label_is_refused(text):
    with pytest.raises(ParameterError, match="label = none"):
        labels(text)


def test_an_assumption_by_a_macro_or_a_cell_is_not_one_of_those_listed(tmp_path):
    for text in ("`define MUST(l, x) l``x: assume (x)\n    `MUST(a_, put);", "\\$assume a_y (.A(put), .EN(1'b1));"):
        place = "always @* begin\n    if (first) a_reset" if "$" in text else PUT
        with pytest.raises(FormalError):
            problems("byte_queue", tmp_path, (place, f"{text}\n  {place}"), l="a reason")


def test_a_declared_exception_must_be_unreachable():
    found = FreedomResult(["a=0", "a=1", "a=0 & b=1"], ["b=1 & a=1"])
    assert found.problems({"b=1 & a=1": "why"}, ()) == []
    assert found.problems({}, ()) == ["b=1 & a=1 = not reached: must be, or be in never"]
    assert found.problems({".*a=1": "why"}, ()) == ["never..*a=1 = reached, or no input: must be unreachable"]
