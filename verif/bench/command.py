"""Every cocotb bench in Icarus and in Verilator, one frame in these and in PyMTL, and frames of every cross of the
chip's configuration: build/verify/bench.json."""

import sys
import tempfile
from argparse import ArgumentParser, Namespace
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from talbot.base.jobs import Job, worker_count
from talbot.base.jobs import run as run_jobs
from talbot.base.records import from_json
from talbot.rtl.harness.icarus import MISSING, installed
from talbot.verif.bench.cross import ARRAYS, Crossed, crossed, every
from talbot.verif.bench.exposure import FRAMES
from talbot.verif.bench.simulation import DESIGNS, SIMULATORS, BenchError, BenchTest, simulate
from talbot.verif.results import OUT, SEED, BlockResults, Tests, write_step

CHIP, SHOWN = "AspChip", "edge"
SAME = "the same bytes in PyMTL, Icarus and Verilator"
NAMES = {"pymtl": "PyMTL3", "verilator": "Verilator", "icarus": "Icarus"}


@dataclass(frozen=True)
class BenchRun:
    """The tests of a block's bench in a simulator. stream: bytes of the chip's shown frame in hexadecimal."""

    tests: list[BenchTest]
    stream: str | None


def bench(block: str, simulator: str, seed: int) -> BenchRun:
    """Run a block's bench; one that cannot be built or run is a failed test."""
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        stream = Path(folder) / "stream"
        try:
            tests = simulate(DESIGNS[block], simulator, seed, {"BENCH_STREAM": str(stream), "BENCH_FRAME": SHOWN})
        except BenchError as error:
            tests = [BenchTest("build and run", str(error))]
        return BenchRun(tests, stream.read_bytes().hex() if stream.exists() else None)


def in_pymtl() -> BenchRun:
    """Run the shown frame in PyMTL."""
    from talbot.verif.bench.pymtl_frame import pymtl_stream

    return BenchRun([], pymtl_stream(FRAMES[SHOWN]).hex())


def jobs_of(blocks: Sequence[str], simulators: Iterable[str], seed: int) -> dict[tuple[str, str], Job]:
    """Return the jobs by (block, simulator)."""
    jobs = {
        (block, simulator): Job(f"{block}.{simulator}", bench, (block, simulator, seed), (seed,))
        for block in blocks
        for simulator in simulators
    }
    if CHIP in blocks:
        jobs[CHIP, "pymtl"] = Job(f"{CHIP}.pymtl", in_pymtl)
    return jobs


def summary(runs: Mapping[tuple[str, str], BenchRun]) -> dict[str, BlockResults]:
    """Return the results by block; every failure is an open point. runs: by (block, simulator)."""
    by_block: dict[str, BlockResults] = {}
    for (block, simulator), ran in runs.items():
        here = by_block.setdefault(block, BlockResults())
        failed = [test for test in ran.tests if test.failure]
        if ran.tests:
            tests = here.benches[NAMES[simulator]] = Tests(len(ran.tests) - len(failed), len(failed))
            here.simulators.append(NAMES[simulator])
            here.tests.add(tests)
        here.open_points += [f"{block} in {simulator}: {test.name}: {test.failure}" for test in failed]
    streams = {simulator: ran.stream for (block, simulator), ran in runs.items() if block == CHIP}
    if streams:
        same = len(set(streams.values())) == 1 and None not in streams.values()
        by_block[CHIP].tests.add(Tests(int(same), int(not same)))
        if not same:
            differences = ", ".join(f"{name} {str(stream)[:60]}" for name, stream in streams.items())
            by_block[CHIP].open_points.append(f"{CHIP}: {SAME}: {differences}")
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


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot cocotb`."""
    parser.add_argument("--block", action="append", choices=DESIGNS, help="may be repeated; default: all")
    parser.add_argument("--simulator", action="append", choices=SIMULATORS, help="default: both")
    parser.add_argument("--seed", type=int, default=SEED, help="of the tests' random numbers")
    parser.add_argument("--out", type=Path, default=OUT, help="folder of bench.json and of the kept results")
    parser.add_argument("--workers", type=worker_count, default=-1, help="processes, -1 for all cores")


def run(options: Namespace) -> int:
    """Return 0, 1 when a test failed."""
    simulators = options.simulator or list(SIMULATORS)
    if "icarus" in simulators and not installed():
        raise BenchError(MISSING)
    jobs = jobs_of(options.block or list(DESIGNS), simulators, options.seed)
    store = options.out / "bench"
    runs = from_json(list[BenchRun], run_jobs(list(jobs.values()), store, "benches", options.workers))
    by_block = summary(dict(zip(jobs, runs, strict=True)))
    if CHIP in by_block and "verilator" in simulators:
        by_block[CHIP].add(crosses(options.seed, store, options.workers))
    write_step("bench", by_block, options.out)
    for job, ran in zip(jobs.values(), runs, strict=True):
        if any(test.failure for test in ran.tests):
            job.file(store).unlink(missing_ok=True)  # failures are tried again
    for block, here in by_block.items():
        print(f"{block}: {here.tests.passed} passed, {here.tests.failed} failed, seed {options.seed}")
        for point in here.open_points:
            print(point, file=sys.stderr)
            print(f"again: talbot cocotb --block {block} --seed {options.seed}", file=sys.stderr)
    return int(any(here.open_points for here in by_block.values()))
