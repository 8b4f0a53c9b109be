"""Traces of failed proofs: planted bugs in three blocks, each shown as a waveform and replayed by a test."""

import dataclasses
import importlib.util
import re

import pytest

from talbot.base.command import main
from talbot.verif.formal import command, design, manifest, replay
from talbot.verif.formal.prove import TOO_WEAK, prove

pytestmark = pytest.mark.needs("yosys-smtbmc", "boolector")


def proof_named(name):
    """The proof ``name``."""
    return next(proof for proof in manifest.every() if proof.name == name)


@pytest.fixture
def plant(monkeypatch):
    """A function that exchanges a text of the exported design for this test."""

    def planted(name, find, new):
        original = design.exported

        def exported(proof):
            texts = original(proof)
            if proof.name != name:
                return texts
            assert sum(text.count(find) for text in texts.values()) == 1
            return {module: text.replace(find, new) for module, text in texts.items()}

        monkeypatch.setattr(design, "exported", exported)

    return planted


BUGS = [
    pytest.param("byte_queue", "head <= second;", "head <= octet;", "p_order", marks=pytest.mark.slow),
    pytest.param("edge_adc", "trial <= 8'd129 - {", "trial <= 8'd130 - {", "p_dac", marks=pytest.mark.slow),
    pytest.param(
        "phase_path",
        "next_x = tap[1'd1] ? x - wide : wide;",
        "next_x = tap[1'd1] && x != 9'd77 && turn[1] ? x - wide : wide;",
        "p_request",
        marks=pytest.mark.slow,
    ),
]


@pytest.mark.parametrize("name, find, new, label", BUGS)
def test_a_bug_is_shown_and_its_trace_replayed(name, find, new, label, plant, monkeypatch, tmp_path, capsys):
    with monkeypatch.context() as patch:
        plant(name, find, new)
        assert main(command, ["--proof", name, "--show", "--out", str(tmp_path)]) == 1
        lines = capsys.readouterr().out.splitlines()
        cycle = re.fullmatch(rf".*\b{label}\b.* of {name} fails in cycle (\d+), from reset", lines[0])[1]
        vcd, test = (tmp_path / "formal" / f"{name}{end}" for end in (".vcd", "_test.py"))
        assert lines[1].endswith(vcd.name) and re.fullmatch(rf"replay: .* -m pytest .*{test.name}", lines[2])
        assert "$enddefinitions" in vcd.read_text() and f"#{10 * int(cycle)}\n" in vcd.read_text()
        spec = importlib.util.spec_from_file_location("replayed", test)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        assert f"{label} in cycle {cycle}" in replay.failures(name, module.CYCLES, module.START)
        with pytest.raises(AssertionError):
            getattr(module, f"test_{name}")()
        patch.undo()
    monkeypatch.undo()
    getattr(module, f"test_{name}")()  # without the bug


@pytest.mark.slow
def test_a_step_from_an_unreachable_state_is_shown_as_such(tmp_path, monkeypatch):
    queue = proof_named("byte_queue")
    text = queue.wrapper.read_text().replace("\\dut.count == inside && inside <= 2", "inside <= 3")
    (tmp_path / "byte_queue.sv").write_text(text)
    loose = dataclasses.replace(queue, wrapper=tmp_path / "byte_queue.sv", depth=1)
    texts, wrapper = design.exported(loose), design.wrapper(loose)
    assert prove(loose, "boolector", texts, wrapper).result == TOO_WEAK
    trace = replay.shortest(loose, "boolector", texts, wrapper)
    assert trace.start and "unreachable" in trace.origin and len(trace.cycles) == 2
    rows = replay.violations(loose, texts, wrapper, trace.cycles, trace.start)
    assert rows[0] == [] and set(rows[1]) >= set(trace.failing)
    assert replay.failures("byte_queue", trace.cycles, trace.start) == []  # the invariant excludes the state


@pytest.mark.slow
def test_a_proof_that_holds_has_no_trace(tmp_path, capsys):
    assert main(command, ["--proof", "scan_queue", "--show", "--out", str(tmp_path)]) == 0
    assert capsys.readouterr().out == "scan_queue = proven: no trace\n"
    assert not (tmp_path / "formal").exists()
    assert main(command, ["--show", "--out", str(tmp_path)]) == 2
    assert capsys.readouterr().err == "verif.formal: error: show = True: must be with --proof\n"


def test_a_trace_counts_up_to_the_first_violated_assumption():
    cycles = [{"reset": 1}, *({"put": 1, "octet": n} for n in range(5))]
    proof = proof_named("byte_queue")
    rows = replay.violations(proof, design.exported(proof), design.wrapper(proof), cycles, {})
    assert ["a_put" in row for row in rows[:4]] == [False, False, False, True]
    assert replay.failures("byte_queue", cycles) == []
