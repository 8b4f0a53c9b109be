"""Every cocotb bench in Icarus and in Verilator, and frames of every cross of the chip's configuration.

Results: build/verify/bench.json.
"""

import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from talbot.base.jobs import Job, worker_count
from talbot.base.jobs import run as run_jobs
from talbot.base.records import from_json
from talbot.rtl.harness.icarus import MISSING, installed
from talbot.verif.bench.cross import ARRAYS, Crossed, crossed, every
from talbot.verif.bench.simulation import DESIGNS, SIMULATORS, BenchError, BenchTest, simulate
from talbot.verif.results import OUT, BlockResults, Tests, seed_of, write_step

CHIP = "AspChip"
NAMES = {"verilator": "Verilator", "icarus": "Icarus"}


def bench(block: str, simulator: str, seed: int) -> list[BenchTest]:
    """Run a block's bench; one that cannot be built or run is a failed test."""
    try:
        return simulate(DESIGNS[block], simulator, seed)
    except BenchError as error:
        return [BenchTest("build and run", str(error))]


def jobs_of(blocks: Sequence[str], simulators: Iterable[str], seed: int) -> dict[tuple[str, str], Job]:
    """Return the jobs by (block, simulator)."""
    return {
        (block, simulator): Job(f"{block}.{simulator}", bench, (block, simulator, seed), (seed,))
        for block in blocks
        for simulator in simulators
    }


def summary(runs: Mapping[tuple[str, str], Sequence[BenchTest]]) -> dict[str, BlockResults]:
    """Return the results by block; every failure is an open point. runs: by (block, simulator)."""
    by_block: dict[str, BlockResults] = {}
    for (block, simulator), ran in runs.items():
        here = by_block.setdefault(block, BlockResults())
        failed = [test for test in ran if test.failure]
        tests = here.benches[NAMES[simulator]] = Tests(len(ran) - len(failed), len(failed))
        here.simulators.append(NAMES[simulator])
        here.tests.add(tests)
        here.open_points += [f"{block} in {simulator}: {test.name}: {test.failure}" for test in failed]
    return by_block


def crosses(seed: int, store: Path, workers: int) -> BlockResults:
    """Run the frames of every cross (cross.py); a wrong frame and a cross without one are open points."""
    jobs = [Job(f"cross-{lanes}", crossed, (lanes, seed), (seed,)) for lanes in ARRAYS]
    done = from_json(list[Crossed], run_jobs(jobs, store, "crosses", workers))
    points = []
    for job, part in zip(jobs, done, strict=True):
        if failed := [f"{CHIP} in verilator: {test.name}: {test.failure}" for test in part.tests if test.failure]:
            job.file(store).unlink(missing_ok=True)
            points += failed
    tests = Tests(sum(not t.failure for part in done for t in part.tests), len(points))
    missing = set(map(str, every())) - {name for part in done for name in part.seen}
    return BlockResults(
        tests=tests, open_points=points + [f"cross {name} = never: must be seen" for name in sorted(missing)]
    )


SEED_OPTION = seed_of("of the tests' random numbers")


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot cocotb`."""
    parser.add_argument("--block", action="append", choices=DESIGNS, help="may be repeated; default: all")
    parser.add_argument("--simulator", action="append", choices=SIMULATORS, help="default: both")
    SEED_OPTION.add(parser)
    parser.add_argument("--out", type=Path, default=OUT, help="folder of bench.json and of the kept results")
    parser.add_argument("--workers", type=worker_count, default=-1, help="processes, -1 for all cores")


def run(options: Namespace) -> int:
    """Return 0, 1 when a test failed."""
    seed = SEED_OPTION.value(options)
    simulators = options.simulator or list(SIMULATORS)
    if "icarus" in simulators and not installed():
        raise BenchError(MISSING)
    jobs = jobs_of(options.block or list(DESIGNS), simulators, seed)
    store = options.out / "bench"
    runs = from_json(list[list[BenchTest]], run_jobs(list(jobs.values()), store, "benches", options.workers))
    by_block = summary(dict(zip(jobs, runs, strict=True)))
    if CHIP in by_block and "verilator" in simulators:
        by_block[CHIP].add(crosses(seed, store, options.workers))
    write_step("bench", by_block, options.out)
    for job, ran in zip(jobs.values(), runs, strict=True):
        if any(test.failure for test in ran):
            job.file(store).unlink(missing_ok=True)  # failures are tried again
    for block, here in by_block.items():
        print(f"{block}: {here.tests.passed} passed, {here.tests.failed} failed, seed {seed}")
        for point in here.open_points:
            print(point, file=sys.stderr)
            print(f"again: talbot cocotb --block {block} --seed {seed}", file=sys.stderr)
    return int(any(here.open_points for here in by_block.values()))
