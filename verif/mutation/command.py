"""Mutants of the RTL under the block's tests: build/verify/mutation.json.

A seeded sample by Yosys, spread over the modules of each block, replaces the block in its tests. A mutant that passes
them all is compared with the original by induction. A survivor is a bug of the tests: exit status 1.
"""

import json
from argparse import ArgumentParser, Namespace
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass
from itertools import islice
from pathlib import Path

from talbot.base.arguments import number_of
from talbot.base.jobs import Job
from talbot.base.jobs import run as run_jobs
from talbot.base.paths import PACKAGE
from talbot.base.records import from_json
from talbot.base.sources import code
from talbot.models.parameters import check_real
from talbot.rtl.replay import load
from talbot.rtl.tops import TOPS
from talbot.verif.coverage.testplan import folder_of
from talbot.verif.coverage.traces import recorded
from talbot.verif.mutation.constants import jobs as constants
from talbot.verif.mutation.judge import (
    EQUIVALENT,
    KILLED,
    SURVIVED,
    Judgement,
    judge,
    proofs_of,
    try_original,
    try_tests,
)
from talbot.verif.mutation.mutants import Mutant, generate, with_mutants
from talbot.verif.mutation.operators import rewritten
from talbot.verif.mutation.planted import jobs as bugs
from talbot.verif.results import OUT, SEED, BlockResults, Mutants, seed_of, write_step
from talbot.verif.verilated.program import compile_program

NUMBERS = {  # of mutants of bits, and as many of the text
    "AmpCtrl": 12,
    "ReadoutSeq": 16,
    "EdgeAdc": 12,
    "AdcBank": 12,
    "QuadDividerRadix2": 8,
    "QuadDividerRadix4": 8,
    "QuadDividerPipelined": 8,
    "Cordic": 8,
    "PhasePath": 12,
    "RunLength": 18,
    "RegFile": 12,
    "AspChip": 12,
    "Proc": 20,  # by name alone: Yosys does not compare it with a mutant within 900 s
}
OTHERS = 2  # parameter sets with a proof, besides the main one


@dataclass(frozen=True)
class Planted:
    """Mutants of a block in one Verilog. path: trace of the component. folder: of mutants.v. bits: of netlist cells."""

    block: str
    path: Path
    folder: Path
    mutants: list[Mutant]

    @property
    def name(self) -> str:
        """Return the name of its jobs."""
        return f"{self.block}-{self.folder.name}"


def plant(block: str, path: Path, folder: Path, number: int, seed: int, bits: bool) -> Planted:
    """Write mutants of the component of trace ``path`` to ``folder``. bits: by Yosys, else of the text."""
    trace = load(path, cycles=False)
    verilog = trace.verilog()
    if bits:
        mutants = generate(verilog, trace.cls, folder_of(block), number, seed)
        text = with_mutants(verilog, trace.cls, mutants)
    else:
        mutants, text = rewritten(verilog, trace.cls, folder_of(block), number, seed)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "mutants.v").write_text(text, encoding="utf-8")
    compile_program(text, trace.cls, trace.ports, mutant=True)
    return Planted(block, path, folder, mutants)


def populations(block: str, paths: Sequence[Path], store: Path, factor: float, seed: int) -> Iterator[Planted]:
    """Yield the mutants of a block: bits and text of its main parameters, text of others (sizes, lanes)."""
    number = factor * NUMBERS[block]
    yield plant(block, paths[0], store / block / "bits", max(4, round(number)), seed, True)
    yield plant(block, paths[0], store / block / "text", max(6, round(number)), seed, False)
    others = (path for path in paths[1:] if any(proofs_of(load(path, cycles=False))))
    for path in islice(others, OTHERS):
        yield plant(block, path, store / block / path.stem, max(6, round(number / 4)), seed, False)


def try_mutants(blocks: Iterable[str], store: Path, factor: float = 1.0, seed: int = SEED) -> dict[str, BlockResults]:
    """Try a sample of mutants of each block. factor: of the sample's size."""
    traces = recorded(blocks := list(blocks), store.parent / "traces")
    groups = [group for block in blocks for group in populations(block, traces[block], store, factor, seed)]
    tests, judges, whole, of = [], [], [], []
    for group in groups:
        text, formal = group.folder / "mutants.v", PACKAGE / "rtl" / folder_of(group.block) / "formal"
        proofs = (formal,) if formal.is_dir() else ()
        decides = group.path.with_suffix(".trace"), text, code(f"rtl/{folder_of(group.block)}/test")
        tried = (str(group.path), str(group.folder), group.folder.name == "bits")  # the tests of a block once
        whole.append(Job(group.name, try_original, tried, decides))
        for mutant in group.mutants:
            name, arguments = f"{group.name}-{mutant.number}", (str(group.path), str(group.folder), mutant)
            tests.append(Job(name, try_tests, arguments, decides))
            judges.append(Job(name, judge, arguments, (text, *proofs)))  # independent of the tests
            of.append(group.block)
    run_jobs(whole, store / "tests", "tests without a mutant")
    results = from_json(list[Judgement], run_jobs(tests, store / "tests", "mutants against the tests"))
    survivors = [i for i, result in enumerate(results) if result.result == SURVIVED]
    judged = run_jobs([judges[i] for i in survivors], store / "judged", "undetected mutants")
    for i, result in zip(survivors, judged, strict=True):
        results[i] = from_json(Judgement, result)
        if results[i].result == SURVIVED:
            judges[i].file(store / "judged").unlink(missing_ok=True)  # survivors are judged again
    mutants = [mutant for group in groups for mutant in group.mutants]
    by_block = {block: [i for i, name in enumerate(of) if name == block] for block in blocks}
    summaries = {block: summary([mutants[i] for i in at], [results[i] for i in at]) for block, at in by_block.items()}
    for block, entry in escaped([*bugs(blocks), *constants(blocks, factor, seed)], store / "planted").items():
        entry.add(summaries[block])
        summaries[block] = entry
    return summaries


def escaped(planned: Sequence[tuple[str, Job]], store: Path) -> dict[str, BlockResults]:
    """Plant bugs, (block, Job) each, of planted.yaml and constants; one that passes its tests is an open point."""
    caught = run_jobs([job for _, job in planned], store, "bugs that escaped once, constants")
    results: dict[str, BlockResults] = {}
    for (block, job), good in zip(planned, caught, strict=True):
        points = [] if good else [f"planted {job.name} = survived: its tests must fail"]
        results.setdefault(block, BlockResults()).add(
            BlockResults(mutants=Mutants(1, killed=int(good), survived=int(not good)), open_points=points)
        )
        if not good:
            job.file(store).unlink(missing_ok=True)
    return results


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


SEED_OPTION = seed_of("of the sample")


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot mutate`."""
    parser.add_argument("--only", nargs="+", choices=NUMBERS, metavar="BLOCK", help=f"of {', '.join(NUMBERS)}")
    SEED_OPTION.add(parser)
    parser.add_argument("--factor", type=number_of, default=1.0, help="of the sample's size")
    parser.add_argument("--out", type=Path, default=OUT, help="folder of mutation.json")


def run(options: Namespace) -> int:
    """Return 0, 1 with survivors."""
    check_real("factor", options.factor, 1e-3, 100)
    seed = SEED_OPTION.value(options)
    summaries = try_mutants(options.only or TOPS, options.out / "mutation", options.factor, seed)
    write_step("mutation", summaries, options.out)
    whole = Counter()
    for block, entry in summaries.items():
        counts = asdict(entry.mutants or Mutants())
        whole.update(counts)
        print(f"{block}: {json.dumps(counts)}", flush=True)
        for text in entry.open_points:
            print(f"  {text}")
    print(f"all, seed {seed}: {json.dumps(whole)}")
    return int(whole[SURVIVED] > 0)
