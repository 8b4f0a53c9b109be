"""Mutants of the text: each kind has its effect, and with none selected the text is the original."""

import random

import pytest

from talbot.models.parameters import SensorParameters
from talbot.rtl.harness.translate import translate_component
from talbot.rtl.tops import build_top
from talbot.verif.coverage.test.coverage_test import recorded_cycles
from talbot.verif.mutation.equivalence import DIFFERENT, compare
from talbot.verif.mutation.operators import (
    Line,
    Module,
    conditions,
    constants,
    operators,
    registers,
    rewritten,
    triggered,
)
from talbot.verif.verilated.program import compile_program

PART = Module(True, {"a": 4, "b": 4, "c": 1, "q": 4}, ["a", "b", "q"], {"__const__X": 9})


def of(kind, value, target="q", clocked=True, reset=False):
    line = Line(1, "", target, "<=" if clocked else "=", value, ";", clocked, reset, clocked)
    return [change.value for change in kind(line, PART, random.Random(1))]


@pytest.mark.parametrize(
    "value, found",
    [
        ("( a + b ) << 1'd1", ["( a - b ) << 1'd1", "( a + b ) << 1 << 1'd1"]),
        ("{ a[1:0], b[3:2] }", ["{ b[3:2], a[1:0] }"]),
        ("c & ( ~a )", ["c | ( ~a )", "c & ( a )"]),
        ("c", []),
    ],
)
def test_operators(value, found):
    assert of(operators, value) == found


def test_another_signal_of_the_same_width():
    assert of(operators, "a") in (["b"], ["q"])


def test_constants():
    assert of(constants, "4'd15")[0] in {"4'd14", "4'd7", "4'd11", "4'd13", "4'd0"}
    assert of(constants, "4'( __const__X ) + a")[0] != "4'd9 + a"
    assert of(constants, "a[3'd3:3'd0]") == []


def test_conditions():
    assert of(conditions, "c", "") == ["~( c )", "1'd0", "1'd1"]
    assert of(conditions, "( c & ( a == b ) ) | q[0]")[:2] == ["( ( a == b ) ) | q[0]", "( c ) | q[0]"]
    assert of(conditions, "c ? a : b") == ["c ? b : a"]
    assert of(conditions, "{ c & c, a }") == ["{ c, a }"] * 2


def test_registers():
    assert of(registers, "4'd0", reset=True) == of(registers, "a") == ["q"]
    assert of(registers, "a", clocked=False) == []
    assert of(registers, "c", "") == ["( c ) | <it>"]


def test_triggers_flip_one_bit():
    found = of(triggered, "a + b")
    assert len(found) == 3 and all(value.startswith("( a + b ) ^ ( <it> ? 4'd") for value in found)
    assert of(triggered, "4'd0") == []


@pytest.mark.needs("yosys-abc")
def test_all_in_one_design(tmp_path):
    trace = recorded_cycles()
    mutants, text = rewritten(trace.verilog(), "EdgeAdc", "edge_adc", 30, 1)
    kinds = [mutant.options.split(":")[0] for mutant in mutants]
    assert {kinds.count(kind) for kind in kinds} == {5} and len(set(kinds)) == 6
    assert rewritten(trace.verilog(), "EdgeAdc", "edge_adc", 30, 2)[0] != mutants
    assert all(mutant.source.startswith("rtl/edge_adc/edge_adc_rtl.py") for mutant in mutants)
    program = compile_program(text, "EdgeAdc", trace.ports, mutant=True)
    path = trace.save(tmp_path).with_suffix(".trace")
    first = program.run(path, "--mutants", "0", "30")
    assert first[0] == -1 and sum(cycle >= 0 for cycle in first.values()) > 8
    seen = next(number for number, cycle in first.items() if cycle >= 0)
    assert compare(text, "EdgeAdc", trace.ports, seen)[0] == DIFFERENT


@pytest.mark.needs("yosys")
def test_a_mutant_below_the_top():
    text = translate_component(build_top("AdcBank", SensorParameters()), "AdcBank")
    mutants, planted = rewritten(text, "AdcBank", "adc_bank", 12, 1)
    assert {mutant.module for mutant in mutants} == {"AdcBank", "LaneResult"}
    assert planted.count(".mutant(mutant)") >= 8
