"""One mutant: against the block's tests; then all inputs of a divider, the equivalence check, the proofs."""

import re
from pathlib import Path

from base.tools import ToolError
from flow.simulate.divider import exhaustive, simulator
from models.parameters import SensorParameters
from rtl.replay import load, tests_of
from verif.coverage.program import compile_program
from verif.formal import design, manifest
from verif.formal.engine import PROVEN
from verif.formal.prove import prove
from verif.results import ROOT

from .equivalence import DIFFERENT, EQUIVALENT, compare, the_same
from .mutants import yosys
from .trial import attempt

KILLED, SURVIVED = "killed", "survived"
SPARE = 1000  # cycles beyond which a test that fails may go on
VARIANTS = {
    "QuadDividerRadix2": "radix2",
    "QuadDividerRadix4": "radix4",
    "QuadDividerPipelined": "pipelined",
    "Cordic": "cordic",
}


def try_tests(path, folder, mutant):
    """What the block's tests make of a Mutant: dict result ('killed' or 'survived'), by.

    path: of the trace whose component is mutated. folder: with mutants.v, all mutants of it. by: the test that fails.
    The recorded cycles tell which test to try first; a mutant that differs in none of them passes all tests, but for
    those that its module has of its own.
    """
    head, verilog = mutated(path, folder)
    program = compile_program(verilog, head.cls, head.ports, mutant=True)
    number = str(mutant.number)
    cycle = program.run(Path(path).with_suffix(".trace"), "--mutants", number, number)[mutant.number]
    own = own_tests(mutant)
    tries = [(own, 2 * head.cycles)] if own else []
    if cycle >= 0:
        test = head.test_at(cycle)
        tries += [(test, 2 * head.cycles_of(test)), (tests_of(head.cls)[1], 2 * head.cycles)]
    for tests, cycles in tries:
        if failed := attempt(head, verilog, mutant, [tests], cycles + SPARE, alone=tests is own).failed:
            return {"result": KILLED, "by": failed}
    return {"result": SURVIVED}


def own_tests(mutant):
    """The test file of the mutated module alone, or None: `test/<name>_test.py` beside its `<name>_rtl.py`."""
    source = ROOT / mutant.source.split(":")[0]
    file = source.parent / "test" / f"{source.stem.removesuffix('_rtl')}_test.py"
    return file if file.exists() and source.stem.removesuffix("_rtl") != source.parent.name else None


def try_original(path, folder):
    """The design with all mutants and none picked must pass what they are tried with. Raises ToolError."""
    head, verilog = mutated(path, folder)
    trial = attempt(head, verilog, None, [tests_of(head.cls)[1]], head.cycles + SPARE)
    if trial.failed or not trial.took_place:
        raise ToolError(f"{head.cls}: no test may fail without a mutant: {trial.failed or 'none has tried it'}")
    return {}


def mutated(path, folder):
    """(Trace without its lines, Verilog with all mutants)."""
    return load(path, cycles=False), (Path(folder) / "mutants.v").read_text()


def judge(path, folder, mutant):
    """What a Mutant is that the tests do not notice: dict result ('killed', 'equivalent', 'survived'), by.

    difference: of a survivor, cycles to the difference that is known to exist, or 'unknown'.
    """
    head, verilog = mutated(path, folder)
    number = mutant.number
    if head.cls in VARIANTS and not divides_right(verilog, head, number):
        return {"result": KILLED, "by": "flow/simulate/divider/test/exhaustive_test.py"}
    if mutant.module != head.cls and the_same(verilog, mutant.module, number):
        return {"result": EQUIVALENT}
    if proof := broken_proof(verilog, head, number):
        return {"result": KILLED, "by": f"proof {proof}"}
    verdict, cycles = compare(verilog, head.cls, head.ports, number)
    if verdict == EQUIVALENT:
        return {"result": EQUIVALENT}
    return {"result": SURVIVED, "difference": cycles if verdict == DIFFERENT else verdict}


def broken_proof(verilog, head, number):
    """Name of a proof of the mutated design that no longer goes through, or None."""
    original = re.sub(r"(?m)^\s*//.*\n", "", head.verilog())
    for proof in manifest.every():
        if list(proof.modules) == [head.cls] and design.exported(proof)[head.cls] == original:
            text = {head.cls: one_mutant(verilog, head.cls, number)}
            if prove(proof, proof.engines[0], text, design.wrapper(proof))["result"] != PROVEN:
                return proof.name
    return None


def divides_right(verilog, head, number):
    """True if mutant ``number`` of a divider gives the golden response for all 2^18 inputs."""
    n_frac = head.arguments[0] if head.cls != "Cordic" else SensorParameters().chip.n_frac
    iterations = head.arguments[0] if head.cls == "Cordic" else SensorParameters().chip.cordic_iterations
    divider = exhaustive.Divider(VARIANTS[head.cls], n_frac, iterations)
    bench = simulator.program(one_mutant(verilog, head.cls, number), head.cls)
    x, y = exhaustive.every_input()
    try:
        mismatches, _, _ = exhaustive.compare(bench, x, y, divider)
    except ToolError:  # it answers what nobody asked
        return False
    return not mismatches


def one_mutant(verilog, top, number):
    """The Verilog of ``top`` with mutant ``number`` and without the input that picks one: text."""
    pick = f"setattr -unset keep w:mutant; connect -set mutant 16'd{number}; delete -input w:mutant"
    text = yosys(
        f"read_verilog -sv mutants.v; hierarchy -check -top {top}; proc; cd {top}; {pick}; cd ..; "
        "write_verilog -noattr one.v",
        {"mutants.v": verilog},
    )["one.v"].decode()
    return "/* verilator lint_off UNOPTFLAT */\n" + text
