"""`python -m verif.bench`: every cocotb bench in Icarus and in Verilator, and one frame in these and in PyMTL."""

import argparse
import sys
import tempfile
from collections import Counter
from pathlib import Path

from base.jobs import Job, run
from models.parameters import ParameterError
from rtl.harness.icarus import MISSING, installed
from verif.results import OUT, write_step

from .exposure import FRAMES
from .simulation import DESIGNS, SIMULATORS, BenchError, simulate

CHIP, SHOWN = "AspChip", "edge"
SAME = "the same bytes in PyMTL, Icarus and Verilator"


def bench(block, simulator, seed):
    """Run a block's bench: {"tests": [[name, failure or None]], "stream": hex of the chip's shown frame, or None}."""
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        stream = Path(folder) / "stream"
        try:
            tests = simulate(DESIGNS[block], simulator, seed, {"BENCH_STREAM": str(stream), "BENCH_FRAME": SHOWN})
        except BenchError as error:
            tests = [("build and run", str(error))]
        return {"tests": tests, "stream": stream.read_bytes().hex() if stream.exists() else None}


def in_pymtl():
    """The shown frame in PyMTL, as `bench`."""
    from .pymtl_frame import pymtl_stream

    return {"tests": [], "stream": pymtl_stream(FRAMES[SHOWN]).hex()}


def jobs_of(blocks, simulators, seed):
    """dict Job -> (block, simulator)."""
    jobs = {
        Job(f"{block}.{simulator}", bench, (block, simulator, seed), (seed,)): (block, simulator)
        for block in blocks
        for simulator in simulators
    }
    if CHIP in blocks:
        jobs[Job(f"{CHIP}.pymtl", in_pymtl)] = CHIP, "pymtl"
    return jobs


def summary(results):
    """(the step's part of the final summary by block, failures: texts). results: dict (block, simulator) -> `bench`."""
    by_block, failures = {}, []
    for (block, simulator), result in results.items():
        here = by_block.setdefault(block, {"tests": Counter(passed=0, failed=0), "simulators": {}, "open_points": []})
        failed = [(test, why) for test, why in result["tests"] if why]
        counts = {"passed": len(result["tests"]) - len(failed), "failed": len(failed)}
        if result["tests"]:
            here["simulators"][simulator] = counts
            here["tests"].update(counts)
        failures += [f"{block} in {simulator}: {test}: {why}" for test, why in failed]
    streams = {simulator: result["stream"] for (block, simulator), result in results.items() if block == CHIP}
    if streams:
        same = len(set(streams.values())) == 1 and None not in streams.values()
        by_block[CHIP]["tests"]["passed" if same else "failed"] += 1
        if not same:
            failures.append(f"{CHIP}: {SAME}: {', '.join(f'{name} {str(s)[:60]}' for name, s in streams.items())}")
    return by_block, failures


def arguments():
    parser = argparse.ArgumentParser(prog="python -m verif.bench", description=__doc__)
    parser.add_argument("--block", action="append", choices=DESIGNS, help="may be repeated; default: every one")
    parser.add_argument("--simulator", action="append", choices=SIMULATORS, help="default: both")
    parser.add_argument("--seed", type=int, default=1, help="of the tests' random numbers (%(default)s)")
    parser.add_argument("--out", type=Path, default=OUT, help="folder of bench.json and of the kept results")
    parser.add_argument("--workers", type=int, default=-1, help="processes, -1 for all cores (%(default)s)")
    return parser


def main(argv=None):
    options = arguments().parse_args(argv)
    simulators = options.simulator or list(SIMULATORS)
    try:
        if "icarus" in simulators and not installed():
            raise BenchError(MISSING)
        jobs = jobs_of(options.block or list(DESIGNS), simulators, options.seed)
        store = options.out / "bench"
        results = dict(zip(jobs.values(), run(jobs, store, "benches", options.workers)))
        by_block, failures = summary(results)
        write_step("bench", by_block, options.out)
    except (ParameterError, BenchError, OSError) as error:
        print(f"verif.bench: {error}", file=sys.stderr)
        return 2
    for job, key in jobs.items():
        if any(why for _, why in results[key]["tests"]):
            (store / f"{job.name}.{job.digest}.json").unlink(missing_ok=True)  # what failed is tried again
    for block, here in by_block.items():
        print(f"{block}: {here['tests']['passed']} passed, {here['tests']['failed']} failed")
    for failure in failures:
        print(failure, file=sys.stderr)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
