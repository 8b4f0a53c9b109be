"""The judgement of a mutant: the block's tests, all inputs of a divider, the equivalence check, the proofs."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from talbot.base.paths import PACKAGE
from talbot.base.tools import ToolError
from talbot.imaging.simulate.divider import exhaustive, simulator
from talbot.models.parameters import SensorParameters
from talbot.rtl.replay import Trace, load
from talbot.signoff.netlist.verilog import modules
from talbot.verif.formal import design, manifest
from talbot.verif.formal.proof import Proof
from talbot.verif.formal.prove import COUNTEREXAMPLE, TOO_WEAK, prove
from talbot.verif.mutation.equivalence import DIFFERENT, EQUIVALENT, UNKNOWN, compare, the_same
from talbot.verif.mutation.mutants import Mutant, yosys
from talbot.verif.mutation.trial import attempt
from talbot.verif.results import PROVEN
from talbot.verif.verilated.program import compile_program

KILLED, SURVIVED = "killed", "survived"
SPARE = 1000  # cycles that a failing test may run longer
VARIANTS = {
    "QuadDividerRadix2": "radix2",
    "QuadDividerRadix4": "radix4",
    "QuadDividerPipelined": "pipelined",
    "Cordic": "cordic",
}


@dataclass(frozen=True)
class Judgement:
    """A mutant's result: 'killed', 'equivalent' or 'survived'.

    by: what kills it, or the proofs that hold with it where no input is known that distinguishes it. difference: of a
    survivor, cycles to a known difference, or 'unknown'.
    """

    result: str
    by: str = ""
    difference: int | str = ""


def try_tests(path: str, folder: str, mutant: Mutant) -> Judgement:
    """Run the block's tests on a mutant: 'killed' or 'survived'.

    path: of the trace whose component is mutated. folder: of mutants.v with all its mutants. The recorded cycles show
    which test to try first; a mutant that differs in none of them passes all tests except those of its module.
    """
    head, verilog = mutated(path, folder)
    program = compile_program(verilog, head.cls, head.ports, mutant=True)
    number = str(mutant.number)
    cycle = program.run(Path(path).with_suffix(".trace"), "--mutants", number, number)[mutant.number]
    module_tests = own_tests(mutant)
    tries = [(module_tests, 2 * head.cycles)] if module_tests else []
    if cycle >= 0:
        test = head.test_at(cycle)
        every = list(dict.fromkeys(name for _, name in head.tests))
        tries += [([test], 2 * head.cycles_of(test)), (every, 2 * head.cycles)]
    for tests, cycles in tries:
        if failed := attempt(head, verilog, mutant, tests, cycles + SPARE, alone=tests is module_tests).failed:
            return Judgement(KILLED, failed)
    return Judgement(SURVIVED)


def own_tests(mutant: Mutant) -> list[Path]:
    """Return the test file of the mutated module alone, if any: `test/<name>_test.py` next to its `<name>_rtl.py`."""
    source = PACKAGE / mutant.source.split(":")[0]
    file = source.parent / "test" / f"{source.stem.removesuffix('_rtl')}_test.py"
    return [file] if file.exists() and source.stem.removesuffix("_rtl") != source.parent.name else []


def try_original(path: str, folder: str, tests: bool) -> None:
    """Replay the recorded cycles on the design with all mutants and none selected, and run the ``tests`` on it, too.

    Raises ToolError where it differs in a cycle, or a test fails.
    """
    head, verilog = mutated(path, folder)
    program = compile_program(verilog, head.cls, head.ports, mutant=True)
    if program.run(Path(path).with_suffix(".trace"), "--mutants", "0", "0") != {0: -1}:
        raise ToolError(f"{head.cls}: no cycle may differ without a mutant: {folder}")
    if not tests:
        return
    # As long as a mutant may run: Hypothesis draws other examples than in the recording, by the modules that are loaded
    limit = 2 * head.cycles + SPARE
    trial = attempt(head, verilog, None, dict.fromkeys(name for _, name in head.tests), limit)
    if trial.failed or not trial.took_place:
        raise ToolError(f"{head.cls}: no test may fail without a mutant: {trial.failed or 'none has tried it'}")


def mutated(path: str, folder: str) -> tuple[Trace, str]:
    """Return the Trace without its lines, and the Verilog with all mutants."""
    return load(path, cycles=False), (Path(folder) / "mutants.v").read_text(encoding="utf-8")


def judge(path: str, folder: str, mutant: Mutant) -> Judgement:
    """Judge a mutant that the tests do not detect. path, folder: see `try_tests`."""
    head, verilog = mutated(path, folder)
    number = mutant.number
    if head.cls in VARIANTS and not divides_right(verilog, head, number):
        return Judgement(KILLED, "imaging/simulate/divider/test/exhaustive_test.py")
    if mutant.module != head.cls and the_same(verilog, mutant.module, number):
        return Judgement(EQUIVALENT)
    holding = []
    for proof in proofs_of(head):
        texts = {module: one_mutant(verilog, module, number) for module in proof.modules}
        changed = [text for text in texts.values() if text != verilog]
        if not any(re.search(rf"(?m)^module {mutant.module}\b", text) for text in changed):
            continue  # it is about other parts
        result = prove(proof, proof.engines[0], texts, design.wrapper(proof), search=False).result
        if result in (COUNTEREXAMPLE, TOO_WEAK):
            return Judgement(KILLED, f"proof {proof.name}")
        if result == PROVEN:
            holding.append(proof.name)
    verdict, cycles = compare(verilog, head.cls, head.ports, number)
    if verdict == EQUIVALENT or verdict == UNKNOWN and holding:
        return Judgement(EQUIVALENT, ", ".join(holding) if verdict == UNKNOWN else "")
    return Judgement(SURVIVED, difference=cycles if verdict == DIFFERENT else verdict)


def proofs_of(head: Trace) -> Iterator[Proof]:
    """Yield the proofs of the component of a trace, or of its parts, at its parameters."""
    original = design.without_comments(head.verilog())
    for proof in manifest.every():
        if {*proof.modules.values()} == {head.cls} and {*design.exported(proof).values()} == {original}:
            yield proof


def divides_right(verilog: str, head: Trace, number: int) -> bool:
    """Return whether mutant ``number`` of a divider gives the golden response for all 2^18 inputs."""
    n_frac = head.arguments[0] if head.cls != "Cordic" else SensorParameters().chip.n_frac
    iterations = head.arguments[0] if head.cls == "Cordic" else SensorParameters().chip.cordic_iterations
    divider = exhaustive.Divider(VARIANTS[head.cls], n_frac, iterations)
    bench = simulator.program(one_mutant(verilog, head.cls, number), head.cls)
    x, y = exhaustive.every_input()
    try:
        mismatches, _, _ = exhaustive.compare(bench, x, y, divider)
    except ToolError:  # it answers without a request
        return False
    return not mismatches


def one_mutant(verilog: str, top: str, number: int) -> str:
    """Return the Verilog of ``top`` with mutant ``number`` and without the input that selects one."""
    if not re.search(r"\bmutant\b", modules(verilog)[top]):  # nor has any module in it
        return verilog
    pick = f"setattr -unset keep w:mutant; connect -set mutant 16'd{number}; delete -input w:mutant"
    text = yosys(
        f"read_verilog -sv mutants.v; hierarchy -check -top {top}; proc; cd {top}; {pick}; cd ..; "
        "write_verilog -noattr one.v",
        {"mutants.v": verilog},
    )["one.v"].decode()
    return "/* verilator lint_off UNOPTFLAT */\n" + text
