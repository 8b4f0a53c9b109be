"""The runner of proofs: results, errors, and detection of a weakened property."""

import dataclasses
import json
import re
import shutil
from argparse import Namespace

import pytest

from talbot.base.command import main
from talbot.base.paths import ROOT
from talbot.models.parameters import ParameterError
from talbot.verif.formal import command, design, manifest, record
from talbot.verif.formal.freedom import freedom
from talbot.verif.formal.items import ProofsFile, failure
from talbot.verif.formal.necessity import necessity
from talbot.verif.formal.plan import pieces
from talbot.verif.formal.proof import Twin, labels
from talbot.verif.formal.prove import CoverResult, ProofResult, TwinResult, cover, prove, twin

pytestmark = pytest.mark.needs("yosys-smtbmc", "boolector")


NO_COVERS = CoverResult([], [], 0.0)


@pytest.fixture(scope="module")
def queue():
    """The proof of the byte queue: small, with every kind of job."""
    return next(proof for proof in manifest.every() if proof.name == "byte_queue")


def changed(proof, folder, find, replace):
    """``proof`` with a wrapper in which ``find`` became ``replace``."""
    text = proof.wrapper.read_text()
    assert text.count(find) == 1
    path = folder / proof.wrapper.name
    path.write_text(text.replace(find, replace))
    return dataclasses.replace(proof, wrapper=path, engines=("boolector",))


def test_every_property_has_a_twin_that_finds_its_place():
    for proof in manifest.every():
        assert set(labels(proof.text).properties) == set(proof.twins), proof.name
        assert all(bug.find != bug.replace for bug in proof.twins.values()), proof.name


def test_pytest_collects_the_proofs_and_can_skip_each(request):
    """Pytest ends with an internal error where a test that it skips has no line."""
    path = ROOT / "rtl/readout_seq/formal/proofs.yaml"
    items = list(ProofsFile.from_parent(request.session, path=path).collect())
    assert [item.name for item in items] == [proof.name for proof in manifest.read(path)]
    assert any(item.get_closest_marker("slow") for item in items)
    assert all(item.location[0].endswith("proofs.yaml") and item.location[1] == 0 for item in items)


def test_of_a_list_of_sizes_the_first_has_covers_and_twins():
    first, *others = (proof for proof in manifest.every() if proof.name.startswith("readout_seq_"))
    assert others and all(proof.size_of == first.name for proof in others)
    assert [piece.name for piece in pieces(others[0], others[0].engines, False)] == [
        "boolector",
        "conjuncts",
        "freedom",
    ]
    assert not {*first.twins, "cover"} & {piece.name for piece in pieces(others[0], others[0].engines)}
    fails = CoverResult([], ["c_frame"], 0.0), {"p_end": TwinResult(False, 0.0, "passed", 20)}
    proven = {"boolector": ProofResult("proven", [], 0.0, "")}
    of_first, of_other = (command.Outcome(proof, proven, *fails) for proof in (first, others[0]))
    assert len(of_first.problems) == 2 and not of_other.problems
    assert [(p.name, p.twin_fails) for p in of_other.properties] == [(others[0].name, False)]
    options = Namespace(only=None, proof=[others[0].name])
    assert command.chosen(manifest.every(), options) == [first, others[0]]


def test_the_record_leaves_out_what_has_not_changed(queue, tmp_path):
    planned = command.plan([queue])
    before = record.digests(planned)
    record.keep(before, tmp_path / "proven.txt")
    assert record.read(tmp_path / "proven.txt") == before == {"run_length/byte_queue.sv": before[next(iter(before))]}
    assert record.unproven(planned, tmp_path / "proven.txt") == []
    for change in ({"depth": queue.depth + 1}, {"timeout": queue.timeout + 1}, {"cover_depth": queue.cover_depth + 1}):
        other = command.plan([dataclasses.replace(queue, **change)])
        assert record.unproven(other, tmp_path / "proven.txt") == other
    other = command.plan([changed(queue, tmp_path, "p_order: assert", "p_order : assert")])
    assert record.unproven(other, tmp_path / "proven.txt") == other
    assert record.unproven(planned, tmp_path / "none.txt") == planned


@pytest.mark.parametrize("argument", [["--changed"], ["--every-size"], ["--proof", "byte_queue"]])
def test_a_part_of_the_proofs_is_no_record(argument, tmp_path, capsys):
    assert main(command, ["--record", *argument, "--out", str(tmp_path)]) == 2
    assert "record = True: must be with all proofs" in capsys.readouterr().err


@pytest.mark.slow
def test_the_byte_queue_is_proven_and_its_twins_fail(queue, tmp_path):
    assert main(command, ["--proof", queue.name, "--out", str(tmp_path), "--workers", "1"]) == 0
    proofs = json.loads((tmp_path / "formal.json").read_text())["RunLength"]["proofs"]
    assert {proof["name"] for proof in proofs} == {f"byte_queue.{label}" for label in queue.twins}
    assert all(
        proof["result"] == "proven" and proof["twin_fails"] and proof["depth"] == "unbounded" for proof in proofs
    )


def test_a_property_that_is_always_true_is_caught_through_its_twin(queue, tmp_path):
    statement = re.search(r"p_order: assert \((.*)\);", queue.wrapper.read_text())[0]
    weak = changed(queue, tmp_path, statement, "p_order: assert (1 || following);")
    texts, wrapper = design.exported(weak), design.wrapper(weak)
    proven = prove(weak, "boolector", texts, wrapper)
    bad, around = design.broken(weak, texts, wrapper, "p_order")
    caught = twin(weak, "p_order", bad, around)
    assert proven.result == "proven" and not caught.fails
    found = command.Outcome(weak, {"boolector": proven}, NO_COVERS, {"p_order": caught})
    assert found.problems == ["RunLength.byte_queue.p_order = passed with its bug in the design: must fail"]


def test_a_wrong_property_is_not_proven(queue, tmp_path):
    wrong = changed(queue, tmp_path, "assert (inside <= 2 &&", "assert (inside <= 1 &&")
    result = prove(dataclasses.replace(wrong, depth=8), "boolector", design.exported(wrong), design.wrapper(wrong))
    assert result.result == "counterexample" and result.failing == ["p_room"]


def test_the_proof_of_a_block_is_a_test_that_names_what_fails(queue, tmp_path):
    wrong = changed(queue, tmp_path, "assert (inside <= 2 &&", "assert (inside <= 1 &&")
    assert failure(queue, tmp_path / "kept") == ""
    message = (
        "byte_queue = counterexample by boolector: must be proven (p_room; talbot formal --proof byte_queue --show)"
    )
    twins = {"p_room": Twin("a text that a bug has changed", "")}
    assert failure(dataclasses.replace(wrong, depth=8, twins=twins), tmp_path / "kept") == message
    assert len(list((tmp_path / "kept").glob("*.json"))) == 1


@pytest.fixture
def loose(queue, tmp_path):
    """The proof of the byte queue without its invariant of the count."""
    loose = changed(queue, tmp_path, "\\dut.count == inside && inside <= 2", "inside <= 3")
    return dataclasses.replace(loose, depth=1)


def test_what_only_induction_refutes_is_no_counterexample(loose):
    result = prove(loose, "boolector", design.exported(loose), design.wrapper(loose))
    assert result.result == "induction too weak"
    found = command.Outcome(loose, {"boolector": result}, NO_COVERS, {})
    assert "= induction too weak by boolector: must be proven" in found.problems[0]


def test_a_bug_that_the_induction_step_finds_is_a_counterexample_from_reset(queue):
    texts, wrapper = design.broken(queue, design.exported(queue), design.wrapper(queue), "p_order")
    result = prove(dataclasses.replace(queue, depth=1), "boolector", texts, wrapper)
    assert result.result == "counterexample" and result.failing == ["p_order"]


def test_a_timeout_is_neither(queue):
    late = dataclasses.replace(queue, timeout=0.01)
    arguments = late, design.exported(late), design.wrapper(late)
    result = prove(late, "boolector", *arguments[1:])
    assert result.result == "timeout"
    found = command.Outcome(late, {"boolector": result}, cover(*arguments), {}, freedom=freedom(*arguments))
    assert [line.split(":")[0] for line in found.problems] == [
        "RunLength.byte_queue = timeout by boolector",
        "RunLength.byte_queue.c_full = timeout",
        "RunLength.byte_queue.c_through = timeout",
        "RunLength.byte_queue",
    ]
    assert "inputs = timeout: " in found.problems[-1]
    assert necessity(*arguments).undecided and not necessity(*arguments).needed


def test_assumptions_that_contradict_each_other_reach_no_cover_point(queue, tmp_path):
    vacuous = changed(queue, tmp_path, "a_put: assume (!put || ready);", "a_put: assume (!put);")
    found = cover(vacuous, design.exported(vacuous), design.wrapper(vacuous))
    assert found.missing == ["c_full", "c_through"]


def test_a_bug_without_its_place_and_a_property_without_a_twin_are_refused(queue, tmp_path):
    texts, wrapper = design.exported(queue), design.wrapper(queue)
    lost = dataclasses.replace(queue, twins={"p_order": Twin("no such text", "")})
    with pytest.raises(ParameterError, match="p_order.find = 'no such text': must occur once, occurs 0 times"):
        design.broken(lost, texts, wrapper, "p_order")
    shutil.copy(queue.wrapper, tmp_path)
    (tmp_path / "proofs.yaml").write_text(
        "- {name: q, block: RunLength, wrapper: byte_queue.sv, top: ByteQueueProof, modules: {ByteQueue: RunLength},\n"
        "   method: induction, depth: 3, why: x, twins: {p_order: {find: a, replace: b}}}\n"
    )
    with pytest.raises(ParameterError, match="q.twins = p_last, p_room, p_stable, p_val: every property must"):
        manifest.read(tmp_path / "proofs.yaml")


@pytest.mark.parametrize(
    "text, message",
    [
        ("assert (a);", "label = none"),
        ("cover (a);", "label = none"),
        ("assume (a);", "label = none"),
        ("assume property (a);", "label = none"),
        ("x: restrict property (a);", "label = none"),
        ("x: assert (a); x: cover (b);", "label = x: must occur once"),
    ],
)
def test_labels_are_given_and_differ(text, message):
    with pytest.raises(ParameterError, match=message):
        labels(text)


def test_a_block_without_proofs_and_an_unknown_one_are_refused(capsys):
    assert main(command, ["--proof", "nothing"]) == 2
    assert capsys.readouterr().err == "verif.formal: error: proof = nothing: must be the name of a proof\n"
    with pytest.raises(SystemExit):
        main(command, ["--only", "Nothing"])
