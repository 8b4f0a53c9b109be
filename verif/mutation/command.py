"""Mutants of the RTL under the block's tests: build/verify/mutation.json.

A seeded sample by Yosys, spread over the modules of each block, replaces the block in its tests. A mutant that passes
them all is compared with the original by induction. A survivor is a bug of the tests: exit status 1.
"""

import json
from argparse import ArgumentParser, Namespace
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import asdict
from pathlib import Path

from base.jobs import Job
from base.jobs import run as run_jobs
from base.paths import ROOT
from base.records import from_json
from base.sources import code
from models.parameters import ParameterError
from rtl.replay import load
from rtl.tops import TOPS
from verif.coverage.program import compile_program
from verif.coverage.testplan import folder_of
from verif.coverage.traces import recorded
from verif.results import OUT, BlockResults, Mutants, write_step

from .judge import EQUIVALENT, KILLED, SURVIVED, Judgement, judge, try_original, try_tests
from .mutants import Mutant, generate, with_mutants

SEED = 1
NUMBERS = {
    "AmpCtrl": 55,
    "ReadoutSeq": 70,
    "EdgeAdc": 40,
    "AdcBank": 40,
    "QuadDividerRadix2": 32,
    "QuadDividerRadix4": 32,
    "QuadDividerPipelined": 32,
    "Cordic": 40,
    "PhasePath": 48,
    "RunLength": 90,
    "RegFile": 55,
    "AspChip": 40,
}


def plant(block: str, path: Path, store: Path, number: int, seed: int) -> tuple[Path, list[Mutant]]:
    """Write mutants of the component of trace ``path`` to a folder of ``store``; returns both."""
    trace = load(path, cycles=False)
    verilog = trace.verilog()
    mutants = generate(verilog, trace.cls, folder_of(block), number, seed)
    text = with_mutants(verilog, trace.cls, mutants)
    folder = store / block
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "mutants.v").write_text(text)
    compile_program(text, trace.cls, trace.ports, mutant=True)
    return folder, mutants


def try_mutants(blocks: Iterable[str], store: Path, factor: float = 1.0, seed: int = SEED) -> dict[str, BlockResults]:
    """Try a sample of mutants of each block. factor: of the sample's size."""
    blocks = list(blocks)
    traces = recorded(blocks, store.parent / "traces")
    tests, judges, whole, made = [], [], [], {}
    for block in blocks:
        path = traces[block][0]
        folder, made[block] = plant(block, path, store, max(4, round(factor * NUMBERS[block])), seed)
        text = folder / "mutants.v"
        decides = path.with_suffix(".trace"), text, code(f"rtl/{folder_of(block)}/test")
        whole.append(Job(block, try_original, (str(path), str(folder)), decides))
        for mutant in made[block]:
            name, arguments = f"{block}-{mutant.number}", (str(path), str(folder), mutant)
            tests.append(Job(name, try_tests, arguments, decides))
            formal = ROOT / "rtl" / folder_of(block) / "formal"
            judges.append(Job(name, judge, arguments, (text, formal)))  # independent of the tests
    run_jobs(whole, store / "tests", "tests without a mutant")
    results = from_json(list[Judgement], run_jobs(tests, store / "tests", "mutants against the tests"))
    left = [i for i, result in enumerate(results) if result.result == SURVIVED]
    for i, result in zip(
        left, run_jobs([judges[i] for i in left], store / "judged", "undetected mutants"), strict=True
    ):
        results[i] = from_json(Judgement, result)
    results = iter(results)
    return {block: summary(mutants, [next(results) for _ in mutants]) for block, mutants in made.items()}


def summary(mutants: Sequence[Mutant], judged: Sequence[Judgement]) -> BlockResults:
    """Return the counts of a block's mutants, with the survivors as open points."""
    count = Counter(judgement.result for judgement in judged)
    return BlockResults(
        mutants=Mutants(len(mutants), count[EQUIVALENT], count[KILLED], count[SURVIVED]),
        open_points=[
            f"mutant {mutant} = survived, difference {judgement.difference}"
            for mutant, judgement in zip(mutants, judged, strict=True)
            if judgement.result == SURVIVED
        ],
    )


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot mutate`."""
    parser.add_argument("--only", nargs="+", choices=TOPS, metavar="BLOCK", help=f"of {', '.join(TOPS)}")
    parser.add_argument("--seed", type=int, default=SEED, help="of the sample")
    parser.add_argument("--factor", type=float, default=1.0, help="of the sample's size")
    parser.add_argument("--out", type=Path, default=OUT, help="folder of mutation.json")


def run(options: Namespace) -> int:
    """Return 0, 1 with survivors."""
    if not 0 < options.factor <= 100:
        raise ParameterError(f"factor = {options.factor}: must be in 0..100")
    found = try_mutants(options.only or TOPS, options.out / "mutation", options.factor, options.seed)
    write_step("mutation", found, options.out)
    whole = Counter()
    for block, entry in found.items():
        counts = asdict(entry.mutants or Mutants())
        whole.update(counts)
        print(f"{block}: {json.dumps(counts)}", flush=True)
        for text in entry.open_points:
            print(f"  {text}")
    print(f"all, seed {options.seed}: {json.dumps(whole)}")
    return int(whole[SURVIVED] > 0)
